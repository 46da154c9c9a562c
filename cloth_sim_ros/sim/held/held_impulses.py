# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The impulses of the cloth on pins and grasps, gathered on the device substep by substep."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any
from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import HALO
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.scene import Scene
import numpy as np

Node = tuple[int, int]
_REST = np.zeros(3)
# Invocations of a workgroup of fold_held.comp [1].
_LOCAL = 32
# Size of a vec4 [bytes], and their number for each holder [1].
_VECTOR_BYTES = 16
_HOLDER_VECTORS = 4
# Copies of the sums [1]: read, written, and kept for an undone step.
_PLACES = 3
# Range of substeps between two folds [1], within which their entries are as many as below; chosen:
# a fold costs little beside them, and results change by rounding only.
_MOST_SUBSTEPS = 64
_FEWEST_SUBSTEPS = 4
# Entries of all pins together [1]: 1 MiB, no more memory than the state of a large cloth.
_ENTRIES = 2**16


class HoldsNodes(Protocol):
    """A grasp."""

    @property
    def name(self) -> str:
        """Get its name."""

    @property
    def nodes(self) -> np.ndarray:
        """Get the nodes it holds, (n, 2) int."""


@dataclass(frozen=True, eq=False)
class Holders:
    """
    What holds nodes: pins, each by itself, and grasps.

    :param nodes: all held nodes by their slots, those of pins first, (slots, 2) int
    :param pins: how many of them are pins of their own
    :param grasps: each with its first slot and the one after its last
    """

    nodes: np.ndarray
    pins: int
    grasps: tuple[tuple[HoldsNodes, int, int], ...]

    @classmethod
    def of(cls, pinned: np.ndarray, grasps: Sequence[HoldsNodes]) -> 'Holders':
        """Return those of the ``pinned`` nodes, (rows, cols) bool, which ``grasps`` hold some."""
        alone = pinned.copy()
        for grasp in grasps:
            alone[tuple(grasp.nodes.T)] = False
        parts = [np.argwhere(alone)]
        begin = pins = len(parts[0])
        placed = []
        for grasp in grasps:
            parts.append(grasp.nodes)
            placed.append((grasp, begin, begin + len(grasp.nodes)))
            begin += len(grasp.nodes)
        return cls(np.concatenate(parts), pins, tuple(placed))

    @cached_property
    def slots(self) -> dict[Node, int]:
        """Return the slot of each node."""
        return {node: slot for slot, node in enumerate(map(tuple, self.nodes.tolist()))}

    @property
    def count(self) -> int:
        """Return how many holders there are: each slot for itself, and grasps."""
        return len(self.nodes) + len(self.grasps)


@dataclass(frozen=True, eq=False)
class Impulses:
    """
    What holders were given over some steps of dt, by the order of ``holders``.

    :param changes: impulse on each over ``Scene.node_mass`` [m/s], (count, 3)
    :param peaks: the strongest of a substep, over its length [m/s2], (count, 3)
    """

    holders: Holders
    changes: np.ndarray
    peaks: np.ndarray


class HeldImpulses:
    """
    Has passes record what pinned nodes are driven with in each substep, and adds it up.

    The impulse on a holder is the mass of its node times the change of velocity that the node
    would have had if it were free, less the change that it had. Passes ask ``reserve`` where to
    leave the first of these for each node and substep, by held.glsl.
    """

    def __init__(self, scene: Scene, layout: Layout, *, compiles: bool = True) -> None:
        """Prepare; where the scene holds no node, nothing is compiled before one is held."""
        self._layout = layout
        # Masses of the nodes, over the one that impulses are over.
        self._shares = scene.node_shares
        self._fold = SceneProgram('fold_held.comp', scene, layout, {'FOLD_LOCAL': _LOCAL})
        if compiles and scene.pinned_nodes().any():
            self._fold.use()
        self._header = -(-layout.stored // 4)
        self._buffer: Buffer | None = None
        self._sums: Buffer | None = None
        # Sums of other holders, which the last ``keep`` has copied.
        self._replaced: Buffer | None = None
        self._own: Buffer | None = None
        self._pinned: np.ndarray | None = None
        self._grasped: tuple[HoldsNodes, ...] = ()
        self._edits = 0
        self._holders: Holders | None = None
        self._capacity = 0
        self._entries = 0
        self._begins = False
        # Uniforms that the pass has.
        self._how: tuple[int, ...] = ()
        # Where the sums are now, and where they were when they were kept.
        self._now = self._kept = 0
        # Whether the present step is recorded.
        self.is_within_step = False
        self._until_last = 0
        # Velocities that pins had as the last step ended, those that rest left out.
        self.velocities: dict[Node, np.ndarray] = {}
        # And those that they have in the present step.
        self._within: dict[Node, np.ndarray] = {}
        self._own_values = np.zeros((0, 4), dtype=np.float32)
        self._has_own_begin = False
        # Read from the device since the last fold.
        self._read: np.ndarray | None = None
        self._goes_on = False
        self._has_frame = False
        self._last: Impulses | None = None
        self._was_recorded = False
        # Whether the last step was recorded, or there was none.
        self.knows_last_step = True

    @property
    def is_recording(self) -> bool:
        """Return whether some node is held in the present step."""
        return self.is_within_step and self._holders is not None

    def begin_step(
            self, pinned: np.ndarray, grasps: Sequence[HoldsNodes],
            velocities: Mapping[Node, np.ndarray],
            caught: Mapping[Node, np.ndarray], *, edits: int = 0) -> Impulses | None:
        """
        Begin a step of dt, or several at once.

        :param pinned: which nodes are held in it, (rows, cols) bool
        :param grasps: that hold some of them
        :param velocities: of pins that move in it [m/s]
        :param caught: velocities of nodes that were free when they were pinned, since the last
            step
        :param edits: State.edits; if equal, the same nodes are pinned
        :return: impulses since ``take`` that are lost, as other nodes are held
        """
        before = None
        if not self._holds_the_same(pinned, grasps, edits):
            before = self.take() if self._has_frame else None
            self._rebuild(pinned, grasps)
        self._edits = edits
        self.is_within_step, self._begins, self._until_last = True, True, 0
        self._was_recorded = self.knows_last_step = True
        if self._holders is not None:
            self._has_own_begin = self._note_changes(
                0, {**self.velocities, **caught}, velocities)
        self._within = dict(velocities)
        return before

    def leave_out_step(self) -> None:
        """Begin a step of dt, or several, that nobody asks for; as ``begin_step``."""
        self.is_within_step = self._was_recorded = self.knows_last_step = False
        self._last = None

    def expect_steps(self, substeps: int) -> None:
        """Skip ``substeps`` that come before those of the last step of dt."""
        self._until_last = substeps

    def end_step(self, velocities: Mapping[Node, np.ndarray]) -> None:
        """
        Add up the rest of the step.

        :param velocities: of pins that still move [m/s]
        """
        if self.is_recording and self._holders is not None:
            ends = self._note_changes(len(self._holders.nodes), self._within, velocities)
            self._add_up(ends=ends)
        self.velocities = dict(velocities)
        self.is_within_step = False

    def reserve(self, substeps: int, place: int = bindings.HELD) -> tuple[int, int, int]:
        """
        Return where the first of ``substeps`` leaves its entries, how many can, and how far apart.

        The entries are bound. May run a pass, which leaves another program in use and takes the
        places 2 and 3.
        """
        assert self._holders is not None and self._buffer is not None  # is_recording says so
        slots = len(self._holders.nodes)
        if self._entries == self._capacity:
            self._add_up()
        at = self._header + self._entries * slots
        count = min(substeps, self._capacity - self._entries)
        self._entries += count
        self._buffer.bind_storage(place)
        return at, count, slots

    def drop_last(self) -> None:
        """Drop the entries of the last substep, which is made again."""
        self._entries -= 1

    def bind(self, place: int = bindings.HELD) -> None:
        """Let the next dispatches leave their entries."""
        if self._buffer is not None:
            self._buffer.bind_storage(place)

    def of_last_step(self) -> Impulses | None:
        """
        Return the impulses of the last step of dt; None where no node was held in it.

        To be asked only if ``knows_last_step``.
        """
        if not self._was_recorded:
            return None
        if self._last is None and self._holders is not None:
            self._last = self._impulses(0)
        return self._last

    def take(self) -> Impulses | None:
        """Return the impulses since this was asked last; None where no node was held since."""
        if not self._has_frame or self._holders is None:
            return None
        taken = self._impulses(2)
        self._has_frame = self._goes_on = False
        return taken

    def forget(self) -> None:
        """Drop all sums: the next state is not the result of the last step."""
        self._holders = self._pinned = self._last = None
        self.knows_last_step = True
        self._grasped = ()
        self.velocities = {}
        self._has_frame = self._goes_on = False

    def keep(self) -> Any:
        """Return what ``restore`` needs to come back to this moment."""
        if self._replaced is not None:
            self._replaced.delete()
            self._replaced = None
        self._kept = self._now
        return (
            self._sums, self._holders, self._pinned, self._grasped, dict(self.velocities),
            self._goes_on, self._has_frame, self._last, self._was_recorded,
            self.knows_last_step)

    def restore(self, kept: Any) -> None:
        """Go back to the moment of ``keep``, the latest one."""
        if self._sums is not kept[0] and self._sums is not None:
            self._sums.delete()
        (self._sums, self._holders, self._pinned, self._grasped, velocities, self._goes_on,
         self._has_frame, self._last, self._was_recorded, self.knows_last_step) = kept
        self._replaced = None
        self.velocities = dict(velocities)
        self._now = self._kept
        self._entries, self.is_within_step, self._read = 0, False, None
        if self._holders is not None:
            self._place(self._holders)

    def delete(self) -> None:
        """Free pass and buffers."""
        for buffer in (self._buffer, self._sums, self._own, self._replaced):
            if buffer is not None:
                buffer.delete()
        self._buffer = self._sums = self._own = self._replaced = None
        self._fold.delete()

    def _holds_the_same(
            self, pinned: np.ndarray, grasps: Sequence[HoldsNodes], edits: int) -> bool:
        return (
            self._pinned is not None
            and (edits == self._edits > 0 or np.array_equal(pinned, self._pinned))
            and [(grasp.name, id(grasp.nodes)) for grasp in grasps]
            == [(grasp.name, id(grasp.nodes)) for grasp in self._grasped])

    def _rebuild(self, pinned: np.ndarray, grasps: Sequence[HoldsNodes]) -> None:
        """Give each held node a slot, and set the sums to zero."""
        self._pinned, self._grasped = pinned.copy(), tuple(grasps)
        self._goes_on = self._has_frame = False
        self._last = self._read = None
        if not pinned.any():
            self._holders = None
            return
        holders = self._holders = Holders.of(pinned, grasps)
        slots = len(holders.nodes)
        sums = np.zeros((_PLACES, holders.count, _HOLDER_VECTORS, 4), dtype=np.float32)
        sums[0, :slots, 0, 3] = np.arange(slots)
        sums[0, :slots, 1, 3] = np.arange(1, slots + 1)
        for at, (_, begin, end) in enumerate(holders.grasps, slots):
            sums[0, at, 0, 3], sums[0, at, 1, 3] = begin, end
        if self._replaced is None:
            self._replaced = self._sums
        elif self._sums is not None:
            self._sums.delete()
        self._sums = Buffer(sums)
        self._now = self._kept = 0
        self._own_values = np.zeros((2 * slots, 4), dtype=np.float32)
        if self._own is not None:
            self._own.delete()
        self._own = Buffer(self._own_values)
        self._place(holders)

    def _place(self, holders: Holders) -> None:
        """Upload the slots of nodes."""
        slots = len(holders.nodes)
        self._capacity = max(_FEWEST_SUBSTEPS, min(_MOST_SUBSTEPS, _ENTRIES // slots))
        size = (self._header + self._capacity * slots) * _VECTOR_BYTES
        if self._buffer is None or self._buffer.bytes < size:
            if self._buffer is not None:
                self._buffer.delete()
            self._buffer = Buffer(size)
        header = np.zeros(self._header * 4, dtype=np.float32)
        places = (holders.nodes + HALO) @ (self._layout.pitch, 1)
        header[places] = np.arange(1, slots + 1)
        self._buffer.write(header)
        self._entries = 0

    def _note_changes(
            self, first: int, before: Mapping[Node, np.ndarray],
            after: Mapping[Node, np.ndarray]) -> bool:
        """Note by how much pins change their velocity; return whether some do."""
        assert self._holders is not None
        values = self._own_values[first:first + len(self._holders.nodes), :3]
        if not (before or after):
            return False
        values[:] = 0.0
        slots = self._holders.slots
        for node in {*before, *after} & slots.keys():
            values[slots[node]] = np.float32(self._shares[node]) * (
                np.asarray(after.get(node, _REST), dtype=np.float32)
                - np.asarray(before.get(node, _REST), dtype=np.float32))
        return bool(values.any())

    def _add_up(self, *, ends: bool = False) -> None:
        """Run the pass over the entries there are."""
        assert self._holders is not None and self._sums is not None and self._own is not None
        if self._has_own_begin or ends:
            self._own.write(self._own_values)
        count, slots = self._holders.count, len(self._holders.nodes)
        into = next(place for place in range(_PLACES) if place not in (self._now, self._kept))
        how = (
            count, slots, self._header, self._entries,
            min(self._until_last, self._entries), self._begins or self._until_last > 0,
            0 if self._has_own_begin else -1, self._entries - 1 if ends else -1,
            self._goes_on, self._now * count, into * count, 0)
        program = self._fold.use()
        if how != self._how:
            program.set_int_vectors('how', np.array(how, dtype=np.int32).reshape(-1, 4))
            self._how = how
        self.bind()
        self._sums.bind_storage(bindings.HELD_SUMS)
        self._own.bind_storage(bindings.HELD_OWN)
        program.dispatch(-(-self._holders.count // _LOCAL))
        shader_writes_visible()
        self._now = into
        self._until_last = max(self._until_last - self._entries, 0)
        self._entries = 0
        self._begins = self._has_own_begin = False
        self._goes_on = self._has_frame = True
        self._read = self._last = None

    def _impulses(self, first: int) -> Impulses:
        assert self._holders is not None and self._sums is not None
        if self._read is None:
            self._read = np.empty(
                (self._holders.count, _HOLDER_VECTORS, 4), dtype=np.float32)
            self._sums.read_into(self._read, self._now * self._read.nbytes)
        return Impulses(
            self._holders, self._read[:, first, :3].astype(float),
            self._read[:, first + 1, :3].astype(float))
