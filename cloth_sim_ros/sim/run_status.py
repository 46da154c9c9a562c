# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a run has come, and how finely it is stepped."""

import math

from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.engines import Engines
from cloth_sim_ros.sim.stepping import Stepping


class RunStatus:
    """The numbers of a Simulation that are known without asking the device."""

    engines: Engines
    stepping: Stepping

    @property
    def is_ready(self) -> bool:
        """Tell whether there is a mode to advance with."""
        return self.engines.current is not None

    @property
    def mode(self) -> str:
        """Return the name of the mode that steps now, or will be the first to."""
        return self.engines.mode

    @property
    def available_modes(self) -> tuple[str, ...]:
        """Return the modes ``set_mode`` takes."""
        return tuple(modes.AVAILABLE)

    @property
    def steps(self) -> int:
        """Return the steps of dt made since the start or the last reset."""
        return self.stepping.steps

    @property
    def time(self) -> float:
        """Return the simulated time since the start or the last reset [s]."""
        return self.stepping.time

    @property
    def substeps(self) -> int:
        """Return the substeps in a step of dt; 0 before there is a mode."""
        return self.engines.in_use.mode.substeps if self.is_ready else 0

    @property
    def stability_limit(self) -> float:
        """Return the longest stable substep of the mode [s]; infinite before there is one."""
        return self.engines.in_use.mode.stability_limit if self.is_ready else math.inf

    @property
    def stability_margin(self) -> float:
        """Return the substep over what it should be at most, see Snapshot."""
        return self.engines.in_use.mode.substep_margin if self.is_ready else 0.0
