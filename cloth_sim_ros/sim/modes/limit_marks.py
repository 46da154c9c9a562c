# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which edges are at their limit at the end of a step, and which were one step before."""

import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim import bindings
from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.modes.limited_springs import LIMITED
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_program import SceneProgram
from cloth_sim_ros.sim.state import State
import numpy as np

_LOCAL = (16, 2)
# Where in a mark the bits of the edges are that are held, engaged, and engaged before.
_HELD, _ENGAGED, _BEFORE = 0, 4, 8
_EDGES = 0xF
# Of the limit: an edge that is let go is engaged until it has come back to this strain.
_RELEASE = 0.5
# Steps without a held edge, after which no edge is engaged any more.
_FADING_STEPS = 8


class LimitMarks:
    """The marks of limit_mark.comp; nothing is done for a cloth that has none."""

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate the marks; the pass is compiled when it is first needed."""
        self._layout = layout
        self._program = SceneProgram('limit_mark.comp', scene, layout, {
            'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1]})
        self._groups = -(-layout.cols // _LOCAL[0]), -(-layout.rows // _LOCAL[1])
        self._edges = sum(
            max(scene.rows - abs(kind.drow), 0) * max(scene.cols - abs(kind.dcol), 0)
            for kind in EDGE_KINDS
            if kind.family in LIMITED and scene.models(kind.family))
        self._marks = np.zeros(layout.stored, dtype=np.uint32)
        self.buffer = Buffer(self._marks)
        # Steps until the marks are all zero again. In the last but one all edges are let go.
        self._fading = 0

    @property
    def are_empty(self) -> bool:
        """Tell whether no edge is engaged, nor was one a step before."""
        return self._fading == 0

    def update(self, state: State, *, some: bool) -> None:
        """Mark the edges of ``state``; ``some`` is False when none can be at its limit."""
        if self.are_empty and not some:
            return
        self._fading = _FADING_STEPS if some else self._fading - 1
        if self.are_empty:
            self._clear()
        else:
            state.bind_in()
            self.buffer.bind_storage(bindings.AT_LIMIT)
            program = self._program.use()
            program.set_float('release', _RELEASE if self._fading > 1 else math.inf)
            program.dispatch(*self._groups)
            shader_writes_visible()

    def count(self) -> dict[str, float]:
        """Return the Snapshot's figures of constraints."""
        if self.are_empty:
            return {}
        self.buffer.read_into(self._marks)
        held, now, before = (
            self._marks >> first & _EDGES for first in (_HELD, _ENGAGED, _BEFORE))
        active = _count_bits(held)
        return {
            'active_constraints': active,
            'active_fraction': active / max(self._edges, 1),
            'constraint_switches': _count_bits(now ^ before),
        }

    def forget(self) -> None:
        """Mark nothing, as at the start."""
        self._fading = 0
        self._clear()

    def delete(self) -> None:
        """Give pass and marks back."""
        self.buffer.delete()
        self._program.delete()

    def _clear(self) -> None:
        self.buffer.write(np.zeros_like(self._marks))


def _count_bits(values: np.ndarray) -> int:
    return int(np.unpackbits(values.astype(np.uint8)).sum())
