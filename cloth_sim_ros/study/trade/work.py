# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How often a run passes over the springs, whatever the device and its load."""

from cloth_sim_ros.sim.simulation import Simulation

# Of the springs of the cloth in an iteration of each solver: the product, and the cycle.
_PASSES = {'multigrid': 6, 'block_jacobi': 1}


class Work:
    """
    Adds up passes over the springs, looked at once a frame.

    A substep of springs is one pass, and a sweep of the adaptive mode one more while an edge is
    at its limit. A substep of mode constraint has those of its solver, by the longest solve
    of the last step.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Begin with nothing."""
        self._simulation = simulation
        self._passes = 0.0
        self._substeps = 0.0

    def add(self, steps: int) -> None:
        """Count ``steps`` of dt that were like the last one."""
        snapshot, scene = self._simulation.snapshot(), self._simulation.scene
        iterations = snapshot.solves * snapshot.mean_iterations
        self._substeps += steps * snapshot.substeps
        self._passes += steps * (
            snapshot.substeps + iterations * _PASSES[scene['solver.preconditioner']])

    def in_a_second(self, seconds: float) -> dict[str, float]:
        """Return substeps and passes in a simulated second, of ``seconds`` simulated."""
        return {'substeps': self._substeps / seconds, 'passes': self._passes / seconds}
