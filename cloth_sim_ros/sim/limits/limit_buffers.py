# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Memory of the edges that are solved for in explicit substeps, and of their impulses."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import BufferRow
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.quick_calls import make
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.state import State
import numpy as np

# Sizes of a vec4, of a uint, and of the impulse of an edge [bytes].
_VECTOR = 16
_WORD = 4
_IMPULSE = 12
# As lists begin, by limit_lists.glsl.
_NONE_MARKED = np.array([0, 1, 1, 0, 0, 0, 0, 0], dtype=np.uint32)
_NEWLY = 4
_HEAD = len(_NONE_MARKED)
# Edges that start at a node and have a limit [1].
EDGES = 4
# Entries of a tally of limit/solve.comp [1], of which there are two.
TALLY = 8
_TALLIES = 2


class LimitBuffers:
    """
    What the passes of shaders/limit/ have in common.

    ``lists`` has what limit_lists.glsl says, ``impulses`` three floats for each edge [m/s],
    ``changes`` the change of velocity of each node by them, and room as limit_give.glsl says,
    ``tally`` the counts of limit/solve.comp: since the host has looked, and in the present dt.
    """

    def __init__(self, layout: Layout) -> None:
        """Allocate all of them, without an impulse."""
        stored = layout.stored
        self._layout = layout
        # Marks, counts and masks [bytes], which a look begins with zero.
        self._looked_at = (2 * layout.block_count + stored) * _WORD
        self.lists = Buffer(
            (_HEAD + 3 * layout.block_count + (2 + EDGES) * stored) * _WORD)
        self._write_head = self.lists.write_calls(_NONE_MARKED)
        self.impulses = Buffer(EDGES * stored * _IMPULSE)
        self.changes = Buffer((2 + EDGES) * stored * _VECTOR)
        self.tally = Buffer(_TALLIES * TALLY * _WORD, is_polled=True)
        self._all = (self.lists, self.impulses, self.changes, self.tally)
        # In the order of their bindings.
        self._row = BufferRow(self._all)
        self.clear()

    @property
    def counts_at(self) -> int:
        """Return where the numbers of listed edges of the blocks begin in ``lists`` [bytes]."""
        return (_HEAD + self._layout.block_count) * _WORD

    def mark_none(self) -> None:
        """Unmark all blocks."""
        make(self.mark_none_calls())

    def mark_none_calls(self) -> list[Call]:
        """Return the calls that ``mark_none`` makes."""
        # Apart: what is filled and then written may keep the fill (Buffer._finish_fill).
        return [*self.lists.clear_calls(_HEAD * _WORD, self._looked_at), *self._write_head]

    def take_newly_listed(self) -> int:
        """Wait for limit/list.comp; return how many edges have come to those listed before."""
        count = np.empty(1, dtype=np.uint32)
        self.lists.read_into(count, _NEWLY * _WORD)
        if count[0]:
            self.lists.write(np.zeros(1, dtype=np.uint32), _NEWLY * _WORD)
        return int(count[0])

    def bind(self, state: State) -> None:
        """Let the next dispatches hold edges in a substep of ``state`` that has been written."""
        state.bind_in()
        state.bind_out()
        self._row.bind_storage(bindings.LIMIT_LISTS)
        if self._layout.texture_loads:
            state.bind_out_textures()
            self.changes.bind_texture(bindings.LIMIT_CHANGES)

    def bind_what_stays(self) -> None:
        """Let the next dispatches do so in any state, whose buffers are bound by themselves."""
        self._row.bind_storage(bindings.LIMIT_LISTS)
        self.lists.bind_dispatches()
        if self._layout.texture_loads:
            self.changes.bind_texture(bindings.LIMIT_CHANGES)

    def bind_for_reading(self, buffer: Buffer, place: int) -> None:
        """Let the next dispatches read ``buffer`` as the passes over the lattice do."""
        if self._layout.texture_loads:
            buffer.bind_texture(place)
        else:
            buffer.bind_storage(place)

    def clear_changes(self) -> None:
        """Forget the changes of velocity."""
        self.changes.clear_first(self._layout.stored * _VECTOR)

    def clear(self) -> None:
        """Drop all impulses."""
        for buffer in self._all:
            buffer.clear()
        self.lists.write(_NONE_MARKED)

    def delete(self) -> None:
        """Release all of them."""
        for buffer in self._all:
            buffer.delete()
