# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run of one contender comes to besides its speed."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.study.modes.stretch import edge_stretch
from cloth_sim_ros.study.modes.stretch import Stretch
from cloth_sim_ros.study.modes.stretch import stretch_of
import numpy as np


class RunRecord:
    """
    Work, stretch and energy of a run, from a snapshot of each step of dt.

    :param scene: that is simulated
    :param start: snapshot before the first step
    """

    def __init__(self, scene: Scene, start: Snapshot) -> None:
        """Begin with the energy at the start."""
        self._scene = scene
        self._start_energy = self._most_energy = start.total_energy
        self._frames: list[np.ndarray] = []
        self._seconds = 0.0
        self._substeps = 0
        self._solves = 0
        self._iterations = 0.0

    def add_step(self, snapshot: Snapshot) -> None:
        """Count the work of the step of dt that ended in ``snapshot``."""
        self._seconds += snapshot.dt
        self._substeps += snapshot.substeps
        self._solves += snapshot.solves
        self._iterations += snapshot.solves * snapshot.mean_iterations

    def add_frame(self, snapshot: Snapshot) -> None:
        """Measure the cloth at the end of a frame."""
        self._frames.append(edge_stretch(self._scene, snapshot.positions))
        self._most_energy = max(self._most_energy, snapshot.total_energy)

    @property
    def stretch(self) -> Stretch:
        """Return the stretch over all frames."""
        return stretch_of(self._frames)

    @property
    def energy_rise(self) -> float:
        """
        Return the most that the energy was above that at the start, over M g L.

        Energy is kinetic, elastic and potential; M is the mass of the cloth and L its height. Of
        symplectic Euler, whose velocities are those of half a substep before, it swings by some
        per mille.
        """
        weight = self._scene.node_mass * self._scene.node_count * float(
            np.linalg.norm(self._scene['gravity']))
        return (self._most_energy - self._start_energy) / (weight * self._scene['height'])

    @property
    def substep_rate(self) -> float:
        """Return the substeps in a simulated second [1/s]."""
        return self._substeps / self._seconds

    @property
    def solve_rate(self) -> float:
        """Return the linear solves in a simulated second [1/s]; 0 in a mode without a solver."""
        return self._solves / self._seconds

    @property
    def iterations_per_solve(self) -> float | None:
        """Return the mean iterations of a solve; None in a mode without a solver."""
        return self._iterations / self._solves if self._solves else None
