# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Say when a run begins to be slower than asked for, and when it no longer is."""

from collections.abc import Callable
import math

from cloth_sim_ros.messages.pace import slow_pace
from cloth_sim_ros.node.pacing import Pacing
from cloth_sim_ros.sim.simulation import Simulation

# [s] of wall time: between two warnings at least, and how long a run has to keep up before that
# is said.
QUIET = 60.0
STEADY = 5.0


class PaceReport:
    """
    Warns once where a run falls behind, and says once that it keeps up again.

    :param warn: is given the warning
    :param say: is given what is no warning
    """

    def __init__(
            self, simulation: Simulation, pacing: Pacing, *, warn: Callable[[str], object],
            say: Callable[[str], object]) -> None:
        """Begin with a run that keeps up."""
        self._simulation = simulation
        self._pacing = pacing
        self._warn = warn
        self._say = say
        self._is_behind = False
        self._warned = -math.inf
        self._steady_since = math.inf

    def look(self, now: float) -> None:
        """Look at the pace at the wall time ``now`` [s]."""
        pacing = self._pacing
        if pacing.too_slow:
            self._steady_since = math.inf
            if not self._is_behind and now - self._warned >= QUIET:
                self._is_behind, self._warned = True, now
                self._warn(slow_pace(
                    pacing.achieved, pacing.factor, substeps=self._simulation.substeps,
                    automatic=self._simulation.scene['auto_substeps']))
        elif self._is_behind and pacing.has_window:
            self._steady_since = min(self._steady_since, now)
            if now - self._steady_since >= STEADY:
                self._is_behind = False
                self._say(f'{pacing.achieved:.3g} x real time: the run keeps up again')
