# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Contact of the cloths of a stack with bodies that move, each by the clock of its cloth."""

from collections.abc import Callable
from collections.abc import Sequence

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.sim.contact.contacts import Contacts
from cloth_sim_ros.sim.contact.contacts import near_shares
from cloth_sim_ros.sim.contact.contacts import Touch
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.model.collider_paths import Change
from cloth_sim_ros.sim.model.collider_paths import StackedPaths
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.colliders import placed
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Vectors of a body in the table of own_bodies.glsl [1], and where those are that it has.
BODY_VECTORS = 8
_CENTRE, _VELOCITY = 0, 1
_AXES, _TURN = slice(2, 5), slice(5, 8)


class StackedContacts(Contacts):
    """
    Act as Contacts do in a run of each cloth alone, to the bit.

    Where the bodies of all cloths are is uploaded at once for each substep in which one moves.

    :param scenes: of each cloth, with the same bodies
    :param firsts: number of the first step of each cloth, (cloths,) int
    :param layout: of the stack, with ``own_bodies``
    :param length: of a substep [s]
    :param most: max. substeps that a run of one cloth makes at once
    :param quiet_until: returns until when other loads than these stay as they are at a time [s]
    """

    def __init__(
            self, scenes: Sequence[Scene], firsts: np.ndarray, layout: Layout, *, length: float,
            most: int, quiet_until: Callable[[float], float]) -> None:
        """Allocate the table; passes are compiled when they are first needed."""
        super().__init__(scenes[0], layout)
        self._dt: float = scenes[0]['dt']
        self._length = length
        self._others_quiet_until = quiet_until
        self._stacked = StackedPaths(scenes, firsts, length=length, most=most)
        self._table = np.zeros(
            (len(scenes), len(self.colliders), BODY_VECTORS, 4), dtype=np.float32)
        self._places = Buffer(self._table)
        # What differs from the table on the device.
        self._change = Change.ALL
        self._moving_limits = np.zeros(self._table.shape[:2])
        # When the present step begins by the clock of the batch [s].
        self._begin = 0.0

    def begin_cloth(self, cloth: int, number: int) -> None:
        """Put the bodies of a cloth back to its start, before step ``number``."""
        self._stacked.begin(cloth, number)

    def move_in(self, cloth: int, move: FrameMove) -> FramePath:
        """Start the motion of a body of a cloth; return its path."""
        return self._stacked.move(cloth, move)

    def present_in(self, cloth: int, time: float) -> tuple[Collider, ...]:
        """Return the bodies of a cloth where they are at its ``time`` [s]."""
        return placed(self.colliders, self._stacked.poses(cloth, time))

    def begin_stacked_step(self, number: int) -> None:
        """Begin the step of that ``number``."""
        self._begin = number * self._dt
        self._stacked.begin_step(number)

    def join(self, forcing: Forcing, begin: float, end: float) -> Forcing:
        """Return ``forcing`` plus the bodies of a substep from ``begin`` to ``end`` [s]."""
        made = round((begin - self._begin) / self._length)
        change = self._stacked.find(made, self._others_quiet_until(begin) - begin)
        if change is not Change.NOTHING:
            self._change = Change.ALL if self._change is Change.ALL else change
        # One touch stands for all bodies, whatever they do.
        return super().join(forcing, 0.0, 0.0)

    def quiet_until(self, now: float) -> float:
        """Return until when bodies move as they do in the substep from ``now`` [s] on."""
        return now + self._stacked.alike * self._length

    def delete(self) -> None:
        """Release everything."""
        super().delete()
        self._places.delete()

    def _bind_near(self) -> None:
        super()._bind_near()
        if self._change is not Change.NOTHING:
            self._upload()
            self._change = Change.NOTHING
        self._places.bind_storage(bindings.OWN_BODIES_TABLE)
        if self._layout.texture_loads:
            self._places.bind_texture(bindings.OWN_BODIES_TABLE)

    def _set_motions(self, program: Program, touch: Touch, length: float) -> None:
        """Set nothing: the motions of all cloths are in the table."""

    def _upload(self) -> None:
        bodies, table = self._stacked, self._table
        if self._change is Change.ALL:
            table[:, :, _VELOCITY, :3] = bodies.velocities
            table[:, :, _VELOCITY, 3] = near_shares(bodies.turns, self._length)
            table[:, :, _AXES, :3] = bodies.axes
            if np.any(self.cores):
                table[:, :, _AXES, 3] = self.near_cores(bodies.axes)
            table[:, :, _TURN, :3] = bodies.turns
            self._moving_limits = self.near_limits(bodies.velocities, self._length)
        table[:, :, _CENTRE, :3] = bodies.centres
        table[:, :, _CENTRE, 3] = self._moving_limits + self.rounding_of(bodies.centres)
        self._places.write(table)
