# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The moving state on the device: pairs of buffers, read from one and written to another."""

from collections.abc import Sequence
from itertools import product
from typing import NamedTuple
from typing import Protocol

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import BufferRow
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.sim.arguments import array
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import HALO
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.low_parts import LowParts
from cloth_sim_ros.sim.device.low_parts import needs_low_parts
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cells import inverse_masses
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# A position [m] or velocity [m/s] beyond it counts as not finite: with the softest and the
# stiffest springs, energies and normals of what is below it do not leave float32.
MOST_MAGNITUDE = 1e12

# Pairs of buffers [1]: two that substeps write in turn, and one with the last state checked; and
# one more for substeps that go back to where they begin.
_PAIRS, _MOST_PAIRS = 3, 4
# The first pair of buffers that holds none of three states: the present one, the one that was
# kept, and the one that a substep has begun with.
_SPARE = {
    states: next(pair for pair in range(_MOST_PAIRS) if pair not in states)
    for states in product(range(_MOST_PAIRS), repeat=3)}


class HeldEntries(Protocol):
    """Where substeps leave what pinned nodes are driven with, by held.glsl."""

    @property
    def is_recording(self) -> bool:
        """Return whether some node is held in the present step."""

    def reserve(self, substeps: int, place: int = bindings.HELD) -> tuple[int, int, int]:
        """Return where the first of ``substeps`` leaves its entries, how many, how far apart."""

    def bind(self, place: int = bindings.HELD) -> None:
        """Bind the entries for the next dispatches."""

    def drop_last(self) -> None:
        """Drop the entries of the last substep, which is made again."""

    def expect_steps(self, substeps: int) -> None:
        """Skip ``substeps`` that come before those of the last step of dt."""


class SubstepEnds(Protocol):
    """The states that a substep begins and ends with."""

    @property
    def pinned(self) -> np.ndarray:
        """Get which nodes are pinned, (rows, cols) bool."""

    def bind_in_textures(self) -> None:
        """Bind the first as textures for the next dispatches."""

    def bind_out_textures(self) -> None:
        """Bind the last as textures for the next dispatches."""

    def bind_out(self) -> None:
        """Bind the last for writing by the next dispatches."""


class StoredPositions(NamedTuple):
    """
    Where the device has the positions of all nodes, four floats each: x y z [m] and a weight.

    The weight is 0 where there is no node.

    :param first: entry of node (0, 0)
    :param pitch: entries from a row to the next
    """

    buffer: Buffer
    first: int
    pitch: int


class State:
    """
    Positions and velocities of all nodes on the device, and which nodes are pinned.

    Of the three pairs of buffers, steps alternate between two; the third holds the state that
    was kept last, so that keeping one costs nothing.

    The velocity of a pinned node is that of its pin. ``edits`` counts the changes made from
    outside, between steps.
    """

    def __init__(
            self, layout: Layout, positions: np.ndarray, pinned: np.ndarray,
            parts: np.ndarray | None = None, *, absent: np.ndarray | None = None,
            has_low_parts: bool = False) -> None:
        """
        Upload ``positions`` [m] at rest.

        :param positions: (rows, cols, 3)
        :param pinned: (rows, cols) bool
        :param parts: what each node stands for as cells.glsl has it, 0 where there is none,
            (rows, cols); None for nodes of equal mass everywhere
        :param absent: nodes that read as NaN, (rows, cols) bool; None for none
        :param has_low_parts: as ``needs_low_parts`` says of the scene
        """
        self._layout = layout
        # Those of equal masses take no memory.
        same = np.broadcast_to(1.0, pinned.shape)
        self._parts = same if parts is None else parts
        self._inverse_masses = same if parts is None else inverse_masses(parts)
        self._absent = absent
        self.pinned = pinned.copy()
        nothing = np.zeros((layout.stored, 4), dtype=np.float32)
        self._positions = [Buffer(nothing) for _ in range(_PAIRS)]
        self._velocities = [Buffer(nothing) for _ in range(_PAIRS)]
        self._pairs = [BufferRow(pair) for pair in zip(self._positions, self._velocities)]
        self._now = 0
        self._kept = 0
        # That a substep of several solves has begun with; None where none is under way.
        self._begun: int | None = None
        self._next = 1
        self.edits = 0
        self._low = LowParts(layout.stored) if has_low_parts else None
        # Where passes leave what pinned nodes are driven with; None where nobody asks.
        self.impulses: HeldEntries | None = None
        # Whether pins were stopped in the step where the cloth would have passed through itself.
        self.were_pins_stopped = False
        self.write(positions, np.zeros_like(positions))

    @property
    def buffer(self) -> Buffer:
        """Return a buffer of as many bytes as any that has four floats for each node."""
        return self._positions[0]

    def checked(
            self, positions: np.ndarray, velocities: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return both as arrays, or raise ClothSimError where they can't be stepped."""
        shape = (*self.pinned.shape, 3)
        return (
            checked_vectors(positions, 'positions', shape, absent=self._absent),
            checked_vectors(velocities, 'velocities', shape, absent=self._absent))

    def write(self, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace all positions [m] and velocities [m/s], (rows, cols, 3); pins are at rest."""
        self.write_rows(0, positions, velocities)

    def write_rows(self, first: int, positions: np.ndarray, velocities: np.ndarray) -> None:
        """Replace those of the rows from ``first`` on, as many as there are given."""
        self.edits += 1
        rows = np.s_[first:first + len(positions)]
        if self._absent is not None:
            there = ~self._absent[rows][..., None]
            positions = np.where(there, positions, 0.0)
            velocities = np.where(there, velocities, 0.0)
        weights = np.where(self.pinned[rows], 0.0, self._inverse_masses[rows])
        # With the ghosts beside them. Ghosts are never written by a step: all pairs need theirs.
        offset = self._offset(first, -HALO)
        position = self._layout.stored_rows(_with_fourth(positions, self._parts[rows]))
        velocity = self._layout.stored_rows(
            _with_fourth(velocities * (weights > 0.0)[..., None], weights))
        for buffer in self._positions:
            buffer.write(position, offset)
        for buffer in self._velocities:
            buffer.write(velocity, offset)
        if self._low is not None:
            self._low.clear(self._layout.index(first, -HALO), len(position) * self._layout.pitch)

    def set_pinned(self, row: int, col: int, pinned: bool) -> None:
        """Hold one node where it is, or release it with the velocity of its pin."""
        if self.pinned[row, col] == pinned:
            return
        self.edits += 1
        self.pinned[row, col] = pinned
        # A step writes no w, so all pairs need it.
        weight = np.full(
            1, 0.0 if pinned else self._inverse_masses[row, col], dtype=np.float32)
        for buffer in self._velocities:
            buffer.write(weight, self._offset(row, col) + 3 * weight.itemsize)
        if pinned:
            self._write(self._velocities, row, col, np.zeros(3))

    def set_pin_velocity(self, row: int, col: int, velocity: np.ndarray) -> None:
        """Let the pinned node (row, col) move with ``velocity`` [m/s], (3,), from now on."""
        self.edits += 1
        self._write(self._velocities, row, col, velocity)

    def place_pin(self, row: int, col: int, position: np.ndarray) -> None:
        """Put the pinned node (row, col), which is close by, at ``position`` [m], (3,)."""
        self._write(self._positions, row, col, position)

    def read_position(self, row: int, col: int) -> np.ndarray:
        """Return where the node (row, col) is [m], (3,)."""
        position = np.empty(3, dtype=np.float32)
        self._positions[self._now].read_into(position, self._offset(row, col))
        return position.astype(float)

    def read_velocity(self, row: int, col: int) -> np.ndarray:
        """Return the velocity of the node (row, col) [m/s], (3,)."""
        velocity = np.empty(3, dtype=np.float32)
        self._velocities[self._now].read_into(velocity, self._offset(row, col))
        return velocity

    def read_positions(self) -> np.ndarray:
        """Return all positions [m], (rows, cols, 3) float32; NaN where there is no node."""
        return self._read(self._positions)

    def read_velocities(self) -> np.ndarray:
        """Return all velocities [m/s], (rows, cols, 3) float32; NaN where there is no node."""
        return self._read(self._velocities)

    @property
    def stored_positions(self) -> StoredPositions:
        """Return where the present positions are; a substep does not write there."""
        return StoredPositions(
            self._positions[self._now], self._layout.index(0, 0), self._layout.pitch)

    def read_kept_positions(self) -> np.ndarray:
        """Return the positions that were kept last [m], (rows, cols, 3)."""
        now, self._now = self._now, self._kept
        try:
            return self.read_positions()
        finally:
            self._now = now

    def bind_in(self) -> None:
        """Bind the present state for the next dispatch."""
        if self._layout.texture_loads:
            self._pairs[self._now].bind_textures(bindings.POSITION_IN)
        else:
            self._pairs[self._now].bind_storage(bindings.POSITION_IN)

    def bind_in_textures(self) -> None:
        """Bind the present state as textures for the next dispatch, on each device."""
        self._pairs[self._now].bind_textures(bindings.POSITION_IN)

    def bind_out(self) -> None:
        """Bind the next state for writing by the next dispatch."""
        self._pairs[self._next].bind_storage(bindings.POSITION_OUT)
        self.bind_low_parts()

    @property
    def pair(self) -> tuple[int, int]:
        """Return which of its buffers are read, and which are written."""
        return self._now, self._next

    def step_calls(self) -> list[Call]:
        """Return the calls that ``bind_in`` and ``bind_out`` make; low parts are left out."""
        now, following = self._pairs[self._now], self._pairs[self._next]
        read = (
            now.texture_calls(bindings.POSITION_IN) if self._layout.texture_loads
            else now.storage_calls(bindings.POSITION_IN))
        return [*read, *following.storage_calls(bindings.POSITION_OUT)]

    def out_texture_calls(self) -> list[Call]:
        """Return the calls that ``bind_out_textures`` makes."""
        return self._pairs[self._next].texture_calls(bindings.POSITION_OUT)

    @property
    def has_low_parts(self) -> bool:
        """Return whether passes change low parts of positions and velocities."""
        return self._low is not None

    def bind_low_parts(self) -> None:
        """Bind the low parts, if there are any, for writing."""
        if self._low is not None:
            self._low.bind(bindings.LOW_PARTS, as_texture=self._layout.texture_loads)

    def bind_for_changes(self) -> None:
        """Bind the present state for writing."""
        self._pairs[self._now].bind_storage(bindings.POSITION_IN)

    def bind_out_for_reading(self) -> None:
        """Bind the next velocities instead of the present ones."""
        self._velocities[self._next].bind_texture(bindings.VELOCITY_IN)

    def bind_out_textures(self) -> None:
        """Bind the next state as well as the present one."""
        self._pairs[self._next].bind_textures(bindings.POSITION_OUT)

    def bind_expected(self) -> None:
        """Bind the present positions, with the next velocities."""
        self._bind(bindings.POSITION_IN, self._positions[self._now])
        self._bind(bindings.VELOCITY_IN, self._velocities[self._next])

    def next_held_entry(self, place: int = bindings.HELD) -> int:
        """Return where the next substep leaves its entries of held.glsl, bound; -1: nowhere."""
        if self.impulses is None or not self.impulses.is_recording:
            return -1
        return self.impulses.reserve(1, place)[0]

    def next_held_entries(self, count: int) -> Sequence[int]:
        """Return the same for up to ``count`` substeps, 1 at least."""
        if self.impulses is None or not self.impulses.is_recording:
            return (-1,) * count
        first, some, apart = self.impulses.reserve(count)
        return range(first, first + some * apart, apart)

    def carry_over(self) -> None:
        """Copy the present state to the next one, for a pass that changes few of its nodes."""
        for buffers in (self._positions, self._velocities):
            buffers[self._now].copy_to(buffers[self._next], 0, buffers[self._now].bytes)

    def swap(self) -> None:
        """Make the written state the present one."""
        self._now = self._next
        self._choose_next()

    def keep(self) -> None:
        """Keep the present state, instead of the one kept before, for ``restore``."""
        self._kept = self._now
        self._choose_next()
        if self._low is not None:
            self._low.keep()

    def restore(self, _: None = None) -> None:
        """Go back to the state that was kept; pins set since then are not undone."""
        self.edits += 1
        self._now = self._kept
        self._begun = None
        self._choose_next()
        if self._low is not None:
            self._low.restore()

    def begin_substep(self) -> None:
        """Keep the present state besides, while a substep of several solves changes it."""
        if len(self._pairs) < _MOST_PAIRS:
            for buffers in (self._positions, self._velocities):
                buffers.append(Buffer(buffers[0].bytes))
                buffers[self._now].copy_to(buffers[-1], 0, buffers[0].bytes)
            self._pairs.append(BufferRow((self._positions[-1], self._velocities[-1])))
        self._begun = self._now
        self._choose_next()

    def end_substep(self) -> None:
        """Drop the state kept by ``begin_substep``."""
        self._begun = None
        self._choose_next()

    def undo_substep(self) -> None:
        """Go back to the state of ``begin_substep``, with low parts of zero."""
        assert self._begun is not None
        self._now, self._begun = self._begun, None
        self._choose_next()
        if self._low is not None:
            self._low.clear(0, self._layout.stored)

    @property
    def ends_of_substep(self) -> SubstepEnds:
        """Return the state of ``begin_substep`` and the present one."""
        assert self._begun is not None
        return _BegunSubstep(self, self._pairs[self._begun], self._pairs[self._now])

    def delete(self) -> None:
        """Release the buffers."""
        for buffer in self._positions + self._velocities:
            buffer.delete()
        if self._low is not None:
            self._low.delete()

    def _bind(self, binding: int, buffer: Buffer) -> None:
        if self._layout.texture_loads:
            buffer.bind_texture(binding)
        else:
            buffer.bind_storage(binding)

    def _choose_next(self) -> None:
        begun = self._kept if self._begun is None else self._begun
        self._next = _SPARE[self._now, self._kept, begun]

    def _read(self, buffers: Sequence[Buffer]) -> np.ndarray:
        stored = np.empty((self._layout.stored, 4), dtype=np.float32)
        buffers[self._now].read_into(stored)
        found = self._layout.load(stored)[..., :3].copy()
        if self._absent is not None:
            found[self._absent] = np.nan
        return found

    def _write(
            self, buffers: list[Buffer], row: int, col: int, values: np.ndarray) -> None:
        buffers[self._now].write(values.astype(np.float32), self._offset(row, col))

    def _offset(self, row: int, col: int) -> int:
        return self._layout.index(row, col) * 4 * np.dtype(np.float32).itemsize


def start_state(scene: Scene, layout: Layout) -> State:
    """Return the state that ``scene`` starts with."""
    return State(
        layout, scene.start_positions(), scene.pinned_nodes(),
        None if scene.cells is None else scene.cells.parts,
        absent=~scene.present_nodes if scene.has_gaps else None,
        has_low_parts=needs_low_parts(scene))


def checked_vectors(
        values: np.ndarray, of: str, shape: tuple[int, ...],
        hint: str = 'give 3 for each node', *, absent: np.ndarray | None = None) -> np.ndarray:
    """
    Return ``values`` as float64 of ``shape``; ClothSimError where a cloth can't have them.

    :param absent: nodes whose values do not count, and are 0 in the result, (rows, cols) bool
    """
    found = array(values, of, shape, hint)
    if absent is not None:
        found = np.where(absent[..., None], 0.0, found)
    largest = np.abs(found).max(initial=0.0)
    # NaN fails this as well.
    if not largest < MOST_MAGNITUDE:
        raise ClothSimError(
            f'{of} must be {shape} numbers below {MOST_MAGNITUDE:g}, got up to {largest:g}: give '
            'finite ones near the origin')
    return found


class _BegunSubstep:
    """A substep of several solves, the last of which has made the present state."""

    def __init__(self, state: State, begin: BufferRow, end: BufferRow) -> None:
        self._state, self._begin, self._end = state, begin, end

    @property
    def pinned(self) -> np.ndarray:
        return self._state.pinned

    def bind_in_textures(self) -> None:
        self._begin.bind_textures(bindings.POSITION_IN)

    def bind_out_textures(self) -> None:
        self._end.bind_textures(bindings.POSITION_OUT)

    def bind_out(self) -> None:
        self._end.bind_storage(bindings.POSITION_OUT)
        self._state.bind_low_parts()


def _with_fourth(vectors: np.ndarray, fourth: np.ndarray | float) -> np.ndarray:
    entries = np.empty((*vectors.shape[:2], 4), dtype=np.float32)
    entries[..., :3] = vectors
    entries[..., 3] = fourth
    return entries
