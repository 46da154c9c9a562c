# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth in this simulation, in one of its layouts."""

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
from peers.cloth import Cloth


class SimulatedCloth:
    """
    A ``Simulation`` of the same scene.

    :param layout: fused or paper
    """

    def __init__(self, cloth: Cloth, layout: str, context: Context) -> None:
        """Compile the shaders."""
        self._run = Simulation(
            Scene({**cloth.scene.values, 'layout': layout}), context=context)

    def step(self, count: int) -> None:
        """Make ``count`` steps of dt."""
        self._run.step(count)
        self._run.finish()

    def positions(self) -> np.ndarray:
        """Return where the nodes are, (rows, cols, 3) [m]."""
        return self._run.positions()

    def close(self) -> None:
        """Free the memory on the device."""
        self._run.close()
