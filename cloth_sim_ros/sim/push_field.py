# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Pushes that act or will act, and the acceleration they give in each step."""

from collections.abc import Callable
from dataclasses import dataclass
from dataclasses import field
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.forcing import Forcing
from cloth_sim_ros.sim.layout import Layout
from cloth_sim_ros.sim.push import Push
import numpy as np

MOST_REGION_PUSHES = 32


@dataclass(frozen=True)
class AppliedPush:
    """
    A push and what it acts on.

    :param nodes: free nodes it is spread over
    """

    push: Push
    nodes: int

    @property
    def impulse(self) -> tuple[float, float, float]:
        """Return the total impulse [N s]."""
        return self.push.impulse


@dataclass
class _Entry:
    push: Push
    nodes: int = 0
    begun: bool = False
    slot: int | None = None
    acceleration: np.ndarray = field(default_factory=lambda: np.zeros(3))


class PushField:
    """
    All pushes of a run.

    :param gravity: acceleration on every node [m/s2]
    :param read_positions: returns the present positions [m], (rows, cols, 3)
    :param pinned: the nodes that don't move now, (rows, cols) bool, kept up to date by its owner
    """

    def __init__(
            self, layout: Layout, node_mass: float, gravity: tuple[float, float, float],
            read_positions: Callable[[], np.ndarray], pinned: np.ndarray) -> None:
        """Start without a push."""
        self._layout = layout
        self._node_mass = node_mass
        self._read_positions = read_positions
        self._pinned = pinned
        self._entries: list[_Entry] = []
        self._mask: np.ndarray | None = None
        self._mask_buffer: Buffer | None = None
        self.still = Forcing(gravity)

    @property
    def applied(self) -> tuple[AppliedPush, ...]:
        """Return the pushes that act or will act."""
        return tuple(AppliedPush(entry.push, entry.nodes) for entry in self._entries)

    def add(self, push: Push, now: float) -> AppliedPush:
        """
        Take up ``push``; it is spread over the nodes in its region when it begins.

        :raises ClothSimError: when no free node is there to push, or too many pushes overlap
        """
        entry = _Entry(push)
        inside = self._nodes_inside(push)
        if not inside.any():
            raise ClothSimError(
                f'no free node lies in the region of the push ({describe_region(push)}): '
                'move or enlarge it, or release a pin')
        entry.nodes = int(np.count_nonzero(inside))
        if push.start <= now:
            self._begin(entry)
        self._entries.append(entry)
        return AppliedPush(push, entry.nodes)

    def plan(self, push: Push) -> None:
        """Take up ``push`` for its start; where no free node is then, it does nothing."""
        self._entries.append(_Entry(push))

    def clear(self) -> int:
        """Drop all pushes; return how many."""
        count = len(self._entries)
        self._entries.clear()
        return count

    def forcing(self, begin: float, end: float) -> Forcing:
        """Return the acceleration of the step from ``begin`` to ``end`` [s]."""
        if not self._entries:
            return self.still
        self._entries = [entry for entry in self._entries if entry.push.end > begin]
        everywhere = np.array(self.still.everywhere)
        regions: dict[int, np.ndarray] = {}
        pushed_everywhere = False
        for entry in self._entries:
            share = entry.push.overlap(begin, end)
            if share == 0.0:
                continue
            if not entry.begun:
                self._begin(entry)
            if entry.slot is None:
                everywhere += share * entry.acceleration
                pushed_everywhere = True
            elif entry.nodes:
                regions[entry.slot] = share * entry.acceleration
        if not regions and not pushed_everywhere:
            return self.still
        return Forcing(
            tuple(everywhere), pushed_everywhere, regions,
            self._mask_buffer if regions else None)

    def __call__(self, begin: float, end: float) -> Forcing:
        """Return the acceleration of the step from ``begin`` to ``end`` [s]."""
        return self.forcing(begin, end)

    def next_begin(self) -> float:
        """Return when the next push begins that has not begun yet [s]; infinite if none does."""
        return min(
            (entry.push.start for entry in self._entries if not entry.begun), default=math.inf)

    def delete(self) -> None:
        """Give the buffer back."""
        if self._mask_buffer is not None:
            self._mask_buffer.delete()

    def _begin(self, entry: _Entry) -> None:
        push = entry.push
        inside = self._nodes_inside(push)
        entry.nodes = int(np.count_nonzero(inside))
        if entry.nodes:
            force = np.array(push.force)
            entry.acceleration = force / (entry.nodes * self._node_mass)
            if push.region == 'sphere':
                entry.slot = self._take_slot(inside)
        entry.begun = True

    def _nodes_inside(self, push: Push) -> np.ndarray:
        inside = ~self._pinned
        if push.region == 'sphere':
            away = self._read_positions() - np.array(push.center, dtype=np.float32)
            inside &= np.einsum('rci,rci->rc', away, away) <= push.radius**2
        return inside

    def _take_slot(self, inside: np.ndarray) -> int:
        taken = {entry.slot for entry in self._entries}
        free = [slot for slot in range(MOST_REGION_PUSHES) if slot not in taken]
        if not free:
            raise ClothSimError(
                f'{MOST_REGION_PUSHES} pushes on spheres act already, no more fit: '
                'wait for one to end, or clear them')
        bit = np.uint32(1 << free[0])
        if self._mask is None:
            self._mask = np.zeros(inside.shape, dtype=np.uint32)
        self._mask = np.where(inside, self._mask | bit, self._mask & ~bit)
        stored = self._layout.store(self._mask)
        if self._mask_buffer is None:
            self._mask_buffer = Buffer(stored)
        else:
            self._mask_buffer.write(stored)
        return free[0]


def describe_region(push: Push) -> str:
    """Return the region of ``push`` in words."""
    if push.region == 'all':
        return 'the whole cloth'
    x, y, z = push.center
    return f'a sphere of {push.radius:g} m around ({x:g}, {y:g}, {z:g})'
