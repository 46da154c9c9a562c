# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which edges are at their limit as a step ends, and which were when this was asked before."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.device.scene_program import SceneProgram
from cloth_sim_ros.sim.limits.limit_law import LIMITED
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.state import State
import numpy as np

# Strain at which an edge that was at its limit counts as let go, over the limit [1]: a definition
# of a count, no results.
_RELEASE = 0.5
# Invocations of a workgroup of limit_mark.comp along a row and a column [1], as in Strips.
_LOCAL = (16, 2)
# First bit in a mark of the edges that are held, engaged, and were engaged before.
_HELD = 0
_ENGAGED = 4
_BEFORE = 8
# Bits of the edges of one cell [1]: four.
_EDGES = 0xF


class LimitMarks:
    """
    The marks of limit_mark.comp; nothing is done for a cloth that has none.

    An edge is held while its limit pulls at it, and engaged from then until it has come back to
    half of its limit: edges that swing at their limit do not switch.
    """

    def __init__(self, scene: Scene, layout: Layout) -> None:
        """Allocate nothing yet; the pass is compiled when it is first needed."""
        self._layout = layout
        self._program = SceneProgram('limit_mark.comp', scene, layout, {
            'LOCAL_X': _LOCAL[0], 'LOCAL_Y': _LOCAL[1]})
        self._groups = -(-layout.cols // _LOCAL[0]), -(-layout.rows // _LOCAL[1])
        self._edges = sum(
            max(scene.rows - abs(kind.drow), 0) * max(scene.cols - abs(kind.dcol), 0)
            for kind in EDGE_KINDS
            if kind.family in LIMITED and scene.models(kind.family))
        self._buffer: Buffer | None = None
        self._figures: dict[str, float] = {}
        self._is_any_engaged = False

    @property
    def buffer(self) -> Buffer | None:
        """Return the marks; None where no edge is engaged, nor was."""
        return self._buffer if self._figures else None

    def update(self, state: State, onset: float, changes: Buffer | None) -> None:
        """
        Mark the edges of ``state``.

        :param onset: strain from which on the limit pulls, where there are no ``changes``
        :param changes: of limit_give.glsl, which say where it pulls; None: by the strain
        """
        if self._buffer is None:
            self._buffer = Buffer(np.zeros(self._layout.stored, dtype=np.uint32))
        state.bind_in()
        self._buffer.bind_storage(bindings.AT_LIMIT)
        # Without changes the shader reads none, but a driver may want something to be bound.
        (changes or self._buffer).bind_storage(bindings.LIMIT_CHANGES)
        program = self._program.use()
        program.set_float('onset', onset)
        program.set_float('release', _RELEASE)
        program.set_int('has_changes', int(changes is not None))
        program.dispatch(*self._groups)
        shader_writes_visible()
        self._count()

    def clear(self) -> None:
        """Mark no edge as held or engaged; those that were count as let go."""
        if self._is_any_engaged and self._buffer is not None:
            marks = self._read()
            before = marks >> _ENGAGED & _EDGES
            self._buffer.write((before << _BEFORE).astype(np.uint32))
            self._count()
        else:
            self._figures = {}

    def report(self) -> dict[str, float]:
        """Return the Snapshot's figures of constraints."""
        return self._figures

    def forget(self) -> None:
        """Mark nothing, as at the start."""
        if self._buffer is not None:
            self._buffer.clear()
        self._figures = {}
        self._is_any_engaged = False

    def delete(self) -> None:
        """Release pass and marks."""
        if self._buffer is not None:
            self._buffer.delete()
            self._buffer = None
        self._program.delete()

    def _read(self) -> np.ndarray:
        marks = np.empty(self._layout.stored, dtype=np.uint32)
        assert self._buffer is not None
        self._buffer.read_into(marks)
        return marks

    def _count(self) -> None:
        marks = self._read()
        held, now, before = (
            marks >> first & _EDGES for first in (_HELD, _ENGAGED, _BEFORE))
        self._is_any_engaged = bool(now.any())
        active = _count_bits(held)
        self._figures = {
            'active_constraints': active,
            'active_fraction': active / max(self._edges, 1),
            'constraint_switches': _count_bits(now ^ before),
        } if marks.any() else {}


def _count_bits(values: np.ndarray) -> int:
    return int(np.unpackbits(values.astype(np.uint8)).sum())
