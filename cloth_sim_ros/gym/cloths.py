# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloths behind an environment: one Simulation, or many that step together in a Batch."""

from abc import ABC
from abc import abstractmethod
from collections.abc import Sequence

from cloth_sim_ros.gym.carry_task import CarryTask
from cloth_sim_ros.gym.carry_task import Moves
from cloth_sim_ros.sim.batch import Batch
from cloth_sim_ros.sim.batch_cloth import ClothOfBatch
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np


class Cloths(ABC):
    """Cloths of one task that make the same number of steps."""

    @abstractmethod
    def positions(self) -> np.ndarray:
        """Return all positions [m], (n, rows, cols, 3) float32."""

    @abstractmethod
    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (n, rows, cols, 3) float32."""

    @abstractmethod
    def strains(self) -> np.ndarray:
        """Return the largest strain of each cloth, (n,)."""

    @abstractmethod
    def times(self) -> np.ndarray:
        """Return the time of each episode [s], (n,)."""

    @abstractmethod
    def views(self) -> Sequence[Simulation | ClothOfBatch]:
        """Return what a camera looks at."""

    @abstractmethod
    def begin(self, numbers: np.ndarray, positions: np.ndarray) -> None:
        """Put cloths of some ``numbers`` (k,) at rest at ``positions`` (k, rows, cols, 3) [m]."""

    @abstractmethod
    def play(self, moves: Moves) -> list[str]:
        """Begin to ``move`` pins and make a frame; return why each was lost, '' for not."""

    @abstractmethod
    def close(self) -> None:
        """Release the device."""


class SingleCloth(Cloths):
    """The cloth of a Simulation, in any mode."""

    def __init__(self, task: CarryTask) -> None:
        """Make the simulation."""
        self._task = task
        self.simulation = Simulation(task.scene, records_forces=False)

    def positions(self) -> np.ndarray:
        """Return all positions [m], (1, rows, cols, 3) float32."""
        return self.simulation.positions()[None]

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (1, rows, cols, 3) float32."""
        return self.simulation.velocities()[None]

    def strains(self) -> np.ndarray:
        """Return the largest strain, (1,)."""
        return np.array([self.simulation.measure().max_strain])

    def times(self) -> np.ndarray:
        """Return the time of the episode [s], (1,)."""
        return np.array([self.simulation.time])

    def views(self) -> Sequence[Simulation]:
        """Return the simulation."""
        return [self.simulation]

    def begin(self, numbers: np.ndarray, positions: np.ndarray) -> None:
        """Put the cloth at rest at ``positions``, (1, rows, cols, 3) [m]."""
        simulation = self.simulation
        simulation.reset()
        for row, col in self._task.held.tolist():
            simulation.pin(row, col)
        simulation.set_state(positions[0], np.zeros_like(positions[0]))

    def play(self, moves: Moves) -> list[str]:
        """Begin to ``move`` pins and make a frame; return why it was lost, '' for not."""
        for (row, col), target, speed in zip(
                moves.nodes.tolist(), moves.targets, moves.speeds.tolist()):
            self.simulation.move_pin(row, col, target, speed=speed)
        try:
            self.simulation.step(self._task.steps)
        except NonFiniteStateError as error:
            return [str(error)]
        return ['']

    def close(self) -> None:
        """Release the device."""
        self.simulation.close()


class BatchedCloths(Cloths):
    """
    Cloths of a Batch, each with the bits that SingleCloth has.

    :raises ClothSimError: when the scene asks for what a Batch lacks
    """

    def __init__(self, task: CarryTask, count: int) -> None:
        """Make the batch."""
        self._task = task
        self.batch = Batch(task.scene, count)

    def positions(self) -> np.ndarray:
        """Return all positions [m], (n, rows, cols, 3) float32."""
        return self.batch.positions()

    def velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (n, rows, cols, 3) float32."""
        return self.batch.velocities()

    def strains(self) -> np.ndarray:
        """Return the largest strain of each cloth, (n,)."""
        return self.batch.max_strains()

    def times(self) -> np.ndarray:
        """Return the time of each episode [s], (n,)."""
        return self.batch.times

    def views(self) -> Sequence[ClothOfBatch]:
        """Return each cloth."""
        return [self.batch.cloth(number) for number in range(self.batch.count)]

    def begin(self, numbers: np.ndarray, positions: np.ndarray) -> None:
        """Put cloths of some ``numbers`` (k,) at rest at ``positions`` (k, rows, cols, 3) [m]."""
        held = self._task.held
        self.batch.reset(numbers)
        self.batch.pin(np.repeat(numbers, len(held)), np.tile(held, (len(numbers), 1)))
        self.batch.set_state(positions, np.zeros_like(positions), numbers)

    def play(self, moves: Moves) -> list[str]:
        """Begin to ``move`` pins and make a frame; return why each was lost, '' for not."""
        self.batch.move_pins(*moves)
        self.batch.step(self._task.steps)
        return [
            f'the state became non-finite before t = {time:.6g} s, and the cloth is where it was '
            'before this action: reset it' if lost else ''
            for lost, time in zip(self.batch.lost.tolist(), self.batch.times.tolist())]

    def close(self) -> None:
        """Release the device."""
        self.batch.close()
