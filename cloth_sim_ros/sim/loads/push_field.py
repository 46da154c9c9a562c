# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pushes that act or will act, and the acceleration they give in each step."""

from collections.abc import Callable
from collections.abc import Iterable
from dataclasses import dataclass
from dataclasses import field
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.device.layout import Layout
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.model.push import Push
import numpy as np

# Max. acceleration by a push [m/s2]: beyond, a sum of pushes would leave float32.
_MOST_ACCELERATION = 1e36
# Max. pushes at a time [1]: each costs time in each substep, and memory for its nodes.
MOST_PUSHES = 1000


@dataclass(frozen=True)
class AppliedPush:
    """
    A push and its nodes.

    :param nodes: free nodes it acts on; 0 for a scheduled one, whose nodes are not known yet
    """

    push: Push
    nodes: int

    @property
    def impulse(self) -> tuple[float, float, float]:
        """Return the total impulse [N s]."""
        return self.push.impulse


@dataclass(eq=False)
class _Entry:
    push: Push
    inside: np.ndarray | None = None
    nodes: int = 0
    acceleration: np.ndarray = field(default_factory=lambda: np.zeros(3))

    @property
    def strength(self) -> float:
        return float(np.linalg.norm(self.acceleration))

    def acts_at(self, time: float) -> bool:
        return self.inside is not None and self.push.start <= time < self.push.end


# Each push, and whether it is still to come.
KeptPushes = tuple[tuple[_Entry, bool], ...]


class PushField:
    """
    All pushes of a run.

    :param masses: ``Scene.node_mass`` and ``node_shares``
    :param gravity: acceleration on every node [m/s2]
    :param read_positions: returns the present positions [m], (rows, cols, 3)
    :param pinned: the nodes that don't move now, (rows, cols) bool, kept up to date by its owner
    :param stand_in: as of Forcing
    """

    def __init__(
            self, layout: Layout, masses: tuple[float, np.ndarray],
            gravity: tuple[float, float, float],
            read_positions: Callable[[], np.ndarray], pinned: np.ndarray,
            stand_in: Buffer | None = None) -> None:
        """Start without a push."""
        self._layout = layout
        self._node_mass, self._mass_shares = masses
        self._read_positions = read_positions
        self._pinned = pinned
        self._entries: list[_Entry] = []
        self._buffer: Buffer | None = None
        self._in_buffer: tuple[tuple[_Entry, float], ...] = ()
        self.still = Forcing(
            gravity, reads_texture=layout.texture_loads,
            stand_in=stand_in if layout.texture_loads else None)
        self._latest: tuple[object, Forcing] = ((), self.still)
        # Arguments of the latest call: a substep asks several times.
        self._asked: object = None

    @property
    def applied(self) -> tuple[AppliedPush, ...]:
        """Return the pushes that act or will act."""
        return tuple(AppliedPush(entry.push, entry.nodes) for entry in self._entries)

    def add(self, push: Push, now: float) -> AppliedPush:
        """
        Add ``push``; it is spread over the free nodes that are in its region as it begins.

        :raises ClothSimError: when it begins now and no free node is there to push, or would be
            accelerated beyond what the device can hold; when there are too many
        """
        self._check_count()
        entry = _Entry(push)
        if push.start <= now:
            self._begin(entry)
            _check(entry)
        self._entries.append(entry)
        return AppliedPush(push, entry.nodes)

    def take_up(self, pushes: Iterable[Push], now: float) -> None:
        """Have ``pushes`` instead of all others; those that have begun act on who is there."""
        self._entries = [_Entry(push) for push in pushes]
        for entry in self._entries:
            if entry.push.start <= now:
                self._begin(entry)

    def clear(self) -> int:
        """Drop all pushes; return how many."""
        count = len(self._entries)
        self._entries.clear()
        return count

    def forcing(self, begin: float, end: float, kick: float | None = None) -> Forcing:
        """
        Return the acceleration of the step from ``begin`` to ``end`` [s]; begin its pushes.

        :param kick: how long it acts in the step [s], if not for all of it; pushes keep their
            impulse
        """
        if not self._entries:
            return self.still
        if (begin, end, kick, tuple(self._entries)) != self._asked:
            scale = 1.0 if kick is None else (end - begin) / kick
            self._compose((entry, scale * share) for entry, share in self._shares(begin, end))
            self._asked = begin, end, kick, tuple(self._entries)
        return self._latest[1]

    def acting(self, now: float) -> Forcing:
        """Return what acts at the moment ``now`` [s], for looking only: nothing begins by it."""
        return self._compose((entry, 1.0) for entry in self._entries if entry.acts_at(now))

    def quiet_until(self, now: float) -> float:
        """Return how long from ``now`` no push acts [s]: ``now`` while one does, or infinite."""
        starts = (entry.push.start for entry in self._entries if entry.push.end > now)
        return max(min(starts, default=math.inf), now)

    def keep(self) -> KeptPushes:
        """Return what ``restore`` needs to come back to this moment."""
        return tuple((entry, entry.inside is None) for entry in self._entries)

    def restore(self, kept: KeptPushes) -> None:
        """
        Go back to the moment of ``keep``: what ended acts again, what began is to come.

        Pushes that were added since then are to come.
        """
        before = [entry for entry, _ in kept]
        self._entries = before + [entry for entry in self._entries if entry not in before]
        for entry, is_to_come in kept:
            if is_to_come:
                entry.inside, entry.nodes = None, 0
        # They may hold nodes and accelerations of pushes that begin again.
        self._in_buffer, self._latest, self._asked = (), ((), self.still), None

    def speed_gained(self, begin: float, end: float) -> float:
        """
        Return by how much pushes make a node faster from ``begin`` to ``end`` [m/s].

        Those that were still to come count with the nodes they had when they last began.
        """
        return sum(
            entry.push.overlap(begin, end) * (end - begin)
            * entry.strength for entry in self._entries)

    def delete(self) -> None:
        """Release the buffer."""
        if self._buffer is not None:
            self._buffer.delete()

    def _check_count(self) -> None:
        if len(self._entries) >= MOST_PUSHES:
            raise ClothSimError(
                f'{MOST_PUSHES} pushes are active or scheduled, which is the maximum: wait for '
                'one to end, or clear them')

    def _shares(self, begin: float, end: float) -> list[tuple[_Entry, float]]:
        """Begin the pushes that act from ``begin`` to ``end`` [s]; return their parts of it."""
        self._entries = [entry for entry in self._entries if entry.push.end > begin]
        shares = [(entry, entry.push.overlap(begin, end)) for entry in self._entries]
        for entry, share in shares:
            if share > 0.0 and entry.inside is None:
                self._begin(entry)
        return shares

    def _compose(self, shares: Iterable[tuple[_Entry, float]]) -> Forcing:
        self._asked = None
        active = tuple((entry, share) for entry, share in shares if share > 0.0 and entry.nodes)
        known, forcing = self._latest
        if active == known:
            return forcing
        in_regions = tuple(pair for pair in active if pair[0].push.region == 'sphere')
        everywhere = np.array(self.still.everywhere)
        for entry, share in active:
            if entry.push.region == 'all':
                everywhere += share * entry.acceleration
        if in_regions and in_regions != self._in_buffer:
            self._upload(in_regions)
        forcing = Forcing(
            tuple(everywhere), len(in_regions) < len(active),
            self._buffer if in_regions else None, active, self._layout.texture_loads,
            self.still.stand_in) if active else self.still
        self._latest = (active, forcing)
        return forcing

    def _begin(self, entry: _Entry) -> None:
        """Spread the push over the free nodes that are in its region now."""
        self._asked = None
        push = entry.push
        entry.inside = ~self._pinned & (self._mass_shares > 0.0)
        if push.region != 'all':
            entry.inside &= push.contains(self._read_positions())
        entry.nodes = int(np.count_nonzero(entry.inside))
        if entry.nodes:
            # All of them are accelerated alike.
            mass = self._node_mass * float(self._mass_shares[entry.inside].sum())
            entry.acceleration = np.array(push.force) / mass

    def _upload(self, in_regions: tuple[tuple[_Entry, float], ...]) -> None:
        accelerations = np.zeros((*self._pinned.shape, 4), dtype=np.float32)
        for entry, share in in_regions:
            accelerations[entry.inside] += (*(share * entry.acceleration), 1.0)
        stored = self._layout.store(accelerations)
        if self._buffer is None:
            self._buffer = Buffer(stored)
        else:
            self._buffer.write(stored)
        self._in_buffer = in_regions


def _check(entry: _Entry) -> None:
    if not entry.nodes:
        raise ClothSimError(
            f'no free node lies in the region of the push ({_in_words(entry.push)}): '
            'move or enlarge it, or release a pin')
    strongest = float(np.abs(entry.acceleration).max())
    if strongest > _MOST_ACCELERATION:
        raise ClothSimError(
            f'the push would accelerate its {entry.nodes} nodes by {strongest:.3g} m/s2, more '
            f'than {_MOST_ACCELERATION:g}: give a smaller force')


def _in_words(push: Push) -> str:
    if push.region == 'all':
        return 'the whole cloth'
    x, y, z = push.center
    return f'a sphere of {push.radius:g} m around ({x:g}, {y:g}, {z:g})'
