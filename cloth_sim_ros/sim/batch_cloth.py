# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One cloth of a batch, as a camera looks at it."""

from dataclasses import dataclass
from typing import Protocol

from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import StoredPositions
import numpy as np


class _Stack(Protocol):
    """What is asked of the stack that the cloth is in."""

    scenes: tuple[Scene, ...]

    def positions(self) -> np.ndarray:
        """Return all positions [m], (cloths, rows, cols, 3)."""

    def stored_positions(self, cloth: int) -> StoredPositions:
        """Return where the device has the positions of one cloth."""

    def colliders(self, cloth: int, time: float) -> tuple[Collider, ...]:
        """Return the colliders of one cloth at its ``time`` [s]."""


class _Batch(Protocol):
    """What is asked of the batch."""

    @property
    def times(self) -> np.ndarray:
        """Return the time of each cloth [s], (count,)."""


@dataclass(frozen=True)
class ClothOfBatch:
    """
    A cloth that steps with others; it shows the present state, whenever it was asked for.

    :param number: of the cloth in the batch
    :param stack: that it is in
    :param place: of the cloth in the stack
    :param context: of the batch
    """

    batch: _Batch
    number: int
    stack: _Stack
    place: int
    context: Context

    @property
    def scene(self) -> Scene:
        """Return its scene."""
        return self.stack.scenes[self.place]

    @property
    def time(self) -> float:
        """Return the simulated time since its start or its reset [s]."""
        return float(self.batch.times[self.number])

    @property
    def colliders(self) -> tuple[Collider, ...]:
        """Return the colliders of its scene where they are now."""
        return self.stack.colliders(self.place, self.time)

    def positions(self) -> np.ndarray:
        """Return its positions [m], (rows, cols, 3) float32; NaN for no node."""
        self.context.make_current()
        return self.stack.positions()[self.place]

    def stored_positions(self) -> StoredPositions:
        """Return where the device has its positions, for a context beside that of the batch."""
        self.context.make_current()
        shader_writes_visible()
        self.context.finish()
        return self.stack.stored_positions(self.place)
