# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Solve for the listed edges in passes over the whole lattice, where they are many."""

from dataclasses import dataclass
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.limits.limit_buffers import LimitBuffers
from cloth_sim_ros.sim.limits.limit_program import LimitProgram
from cloth_sim_ros.sim.limits.limit_program import Limits
from cloth_sim_ros.sim.limits.limit_program import MOST_ROUNDS
from cloth_sim_ros.sim.limits.limit_program import MOST_SCALE
from cloth_sim_ros.sim.loads.forcing import Touch
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Rounds between two looks at what they change [1]: a look waits for the device.
_ROUNDS_AT_ONCE = 4


@dataclass(frozen=True)
class LatticeSolve:
    """
    The work of a substep.

    :param listed: edges
    :param active: those that have an impulse
    :param rounds: that were made
    :param is_reached: whether they sufficed
    :param energy: that the impulses have given to the nodes, over their mass [m2/s2]
    :param missed: whether edges are far beyond their limit that had no impulse before
    """

    listed: int
    active: int
    rounds: int
    is_reached: bool
    energy: float
    missed: int = 0


class LatticeRounds:
    """
    The passes limit/nodes.comp, edges.comp and finish.comp, each over all nodes.

    A round is a pass over the nodes and one over the edges; blocks without listed edges are left
    out. It is the same method as in limit/solve.comp, with a look every few rounds.
    """

    def __init__(self, scene: Scene, layout: Layout, buffers: LimitBuffers) -> None:
        """Allocate room for two more sets of impulses; passes are compiled when first used."""
        self._layout = layout
        self._buffers = buffers
        self._nodes = LimitProgram('limit/nodes.comp', scene, layout)
        self._edges = LimitProgram('limit/edges.comp', scene, layout)
        self._finish = LimitProgram('limit/finish.comp', scene, layout)
        self._others = tuple(Buffer(buffers.impulses.bytes) for _ in range(2))
        self._figures = np.empty((layout.block_count, 2), dtype=np.float32)
        self._figures_buffer = Buffer(self._figures.nbytes, is_polled=True)
        self._missed = 0
        self._counts = np.empty(layout.block_count, dtype=np.uint32)

    def count(self) -> int:
        """Wait for limit/list.comp, and return how many edges are listed."""
        self._buffers.lists.read_into(self._counts, self._buffers.counts_at)
        return int(self._counts.sum())

    def solve(
            self, limits: Limits, touch: Touch | None, held_at: int, *,
            gives: bool) -> LatticeSolve:
        """
        Find the impulses of the listed edges, and give them to their nodes.

        :param held_at: where the entries of held.glsl are, bound by now; below 0: nowhere
        :param gives: False leaves the nodes as they are
        """
        listed = self.count()
        if listed == 0:
            return LatticeSolve(0, 0, 0, True, 0.0)
        rounds, is_reached = self._find(limits, touch)
        active, energy = self.give(limits, held_at, gives=gives)
        return LatticeSolve(listed, active, rounds, is_reached, energy, self._missed)

    def run_all_passes(self, limits: Limits, touch: Touch | None, held_at: int) -> None:
        """Run each pass once, for any list."""
        self._find(limits, touch)
        self.give(limits, held_at)

    def delete(self) -> None:
        """Release passes and room."""
        for program in (self._nodes, self._edges, self._finish):
            program.delete()
        for buffer in (*self._others, self._figures_buffer):
            buffer.delete()

    def _find(self, limits: Limits, touch: Touch | None) -> tuple[int, bool]:
        """Leave the impulses in their buffer; return the rounds, and whether they sufficed."""
        buffers = self._buffers
        # Blocks that are left out are not written, either.
        for buffer in self._others:
            buffer.clear()
        self._figures_buffer.bind_storage(bindings.LIMIT_FIGURES)
        buffers.bind_for_reading(buffers.changes, bindings.LIMIT_CHANGES)
        last, previous, out = buffers.impulses, buffers.impulses, self._others[0]
        parts, momentum = (self._scale(limits, touch), 0.0), 1.0
        enough = 0.0
        for rounds in range(1, MOST_ROUNDS + 1):
            self._round(limits, touch, (last, previous), parts, out)
            previous, last = last, out
            out = next(
                buffer for buffer in (buffers.impulses, *self._others)
                if buffer not in (last, previous))
            if rounds == 1 or rounds % _ROUNDS_AT_ONCE == 0:
                overshoot, change = self._look()
                if rounds == 1:
                    enough = self._edges.sufficient(limits, change)
                # NaN counts as found: the check of the state sees it.
                if not change > enough:
                    break
                momentum = 1.0 if overshoot > 0.0 else momentum
            following = 0.5 * (1.0 + math.sqrt(1.0 + 4.0 * momentum**2))
            extra = (momentum - 1.0) / following
            parts, momentum = (1.0 + extra, -extra), following
        if last is not buffers.impulses:
            last.copy_to(buffers.impulses, 0, last.bytes)
        return rounds, not change > enough

    def _scale(self, limits: Limits, touch: Touch | None) -> float:
        """Return the factor of the impulses before that takes most from the energy."""
        impulses = self._buffers.impulses
        without, missed = self._pull(limits, touch, impulses, 0.0)
        self._missed = int(missed)
        slope = without - self._pull(limits, touch, impulses, 1.0)[0]
        return min(max(without / slope, 0.0), MOST_SCALE) if slope > 0.0 else 0.0

    def _pull(
            self, limits: Limits, touch: Touch | None, impulses: Buffer,
            part: float) -> tuple[float, float]:
        self._run_nodes(limits, touch, (impulses, impulses), (part, 0.0), counts_edges=True)
        self._run_edges(limits, (part, 0.0), finds_gain=True)
        return self._look()

    def _round(
            self, limits: Limits, touch: Touch | None, impulses: tuple[Buffer, Buffer],
            parts: tuple[float, float], out: Buffer) -> None:
        self._run_nodes(limits, touch, impulses, parts, counts_edges=False)
        out.bind_storage(bindings.LIMIT_IMPULSES_OUT)
        self._run_edges(limits, parts, finds_gain=False)

    def _run_nodes(
            self, limits: Limits, touch: Touch | None, impulses: tuple[Buffer, Buffer],
            parts: tuple[float, float], *, counts_edges: bool) -> None:
        nodes = self._nodes.use(limits, touch)
        for buffer, place in zip(impulses, (bindings.LIMIT_IMPULSES, bindings.LIMIT_PREVIOUS)):
            self._buffers.bind_for_reading(buffer, place)
        nodes.set_pair('parts', parts)
        nodes.set_int('counts_edges', int(counts_edges))
        nodes.dispatch(*self._layout.groups)
        shader_writes_visible()

    def _run_edges(
            self, limits: Limits, parts: tuple[float, float], *, finds_gain: bool) -> None:
        edges = self._edges.use(limits)
        edges.set_pair('parts', parts)
        edges.set_int('finds_gain', int(finds_gain))
        edges.dispatch(*self._layout.groups)
        shader_writes_visible()

    def _look(self) -> tuple[float, float]:
        """Wait for the last pass; return the sum of the first figures, the largest second one."""
        self._figures_buffer.read_into(self._figures)
        return (
            float(self._figures[:, 0].sum(dtype=np.float64)), float(self._figures[:, 1].max()))

    def give(self, limits: Limits, held_at: int, *, gives: bool = True) -> tuple[int, float]:
        """
        Give the nodes the impulses that were found.

        :param gives: False leaves them as they are, and notes what they would be given
        :return: how many edges have impulses, and the energy that these give over the mass of a
            node [m2/s2]
        """
        self._figures_buffer.bind_storage(bindings.LIMIT_FIGURES)
        self._buffers.impulses.bind_storage(bindings.LIMIT_IMPULSES)
        finish = self._finish.use(limits)
        finish.set_int('held_at', held_at)
        finish.set_int('gives', int(gives))
        finish.dispatch(*self._layout.groups)
        shader_writes_visible()
        self._figures_buffer.read_into(self._figures)
        active, energy = self._figures.sum(axis=0, dtype=np.float64)
        return int(active), float(energy)
