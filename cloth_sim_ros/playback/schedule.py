# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What of a recording is played, and when each message is due on the wall clock."""

from dataclasses import dataclass

from cloth_sim_ros.sim.errors import ClothSimError


@dataclass(frozen=True)
class PlayOptions:
    """
    The wishes of whoever plays a recording.

    :param rate: time of the recording per wall time
    :param loop: True to begin again at the end
    :param start: where to begin, after the begin of the recording [s]
    :param duration: how much to play [s]; infinite for all
    :param topics: names of those to play; empty for all
    :param paused: True to wait for ~/pause with data: false
    :param clock: True to publish /clock: the recorded one, or else simulated time
    :param delay: wall time before the first message, in which readers find the player [s]
    :param node: name of the recorded node, with its namespace
    :param played_node: name that its topics get instead; empty to leave it
    :raises ClothSimError: for a number outside its range
    """

    rate: float = 1.0
    loop: bool = False
    start: float = 0.0
    duration: float = float('inf')
    topics: tuple[str, ...] = ()
    paused: bool = False
    clock: bool = False
    delay: float = 1.0
    node: str = 'cloth_sim'
    played_node: str = ''

    def __post_init__(self) -> None:
        """Check the numbers."""
        # A slower rate than this stands for a slip of the hand; so does a faster one.
        for name, value, low, high in (
                ('--rate', self.rate, 1e-6, 1e6), ('--start', self.start, 0.0, 1e9),
                ('--duration', self.duration, 0.0, float('inf')),
                ('--delay', self.delay, 0.0, 1e6)):
            if not low <= value <= high:
                raise ClothSimError(
                    f'{name} {value:g} is outside its range: give a value from {low:g} to '
                    f'{high:g}')

    def played_name(self, topic: str) -> str:
        """Return the name under which the recorded ``topic`` is played."""
        recorded = f'/{self.node.strip("/")}/'
        if self.played_node and topic.startswith(recorded):
            return f'/{self.played_node.strip("/")}/{topic.removeprefix(recorded)}'
        return topic


# When each message of a recording is due on the wall clock.

# A message that is late goes out at once, and so do those behind it until the schedule is met
# again. Further behind than this [s], the schedule moves: a process that was held up for a minute
# would otherwise pour that minute out in one go.
CATCH_UP = 0.5


class PlayClock:
    """
    A schedule that runs ``rate`` times as fast as the recording.

    The caller gives the wall time [s], of any clock that only goes forward, and the time of the
    recording [ns].

    :param rate: time of the recording per wall time, above 0
    """

    def __init__(self, rate: float) -> None:
        """Wait for start."""
        self._rate = rate
        self._wall = 0.0
        self._time = 0
        self._latest = 0
        self._paused_at: float | None = None
        self.furthest_behind = 0.0
        self.slipped = 0.0

    def start(self, wall: float, time: int) -> None:
        """Have ``time`` due at ``wall``, and all else from there on."""
        self._wall, self._time, self._latest = wall, time, time
        if self._paused_at is not None:
            self._paused_at = wall

    @property
    def paused(self) -> bool:
        """Return whether nothing is due."""
        return self._paused_at is not None

    def pause(self, wall: float) -> None:
        """Stop at ``wall``."""
        if self._paused_at is None:
            self._paused_at = wall

    def resume(self, wall: float) -> None:
        """Resume from where the clock stopped."""
        if self._paused_at is not None:
            self._wall += wall - self._paused_at
            self._paused_at = None

    def delay(self, wall: float, time: int) -> float:
        """
        Return the wall seconds until a message of ``time`` is due; 0 when it is late.

        A message that goes back in time is due with the one before it.
        """
        self._latest = max(self._latest, time)
        due = self._wall + (self._latest - self._time) * 1e-9 / self._rate
        behind = wall - due
        if behind > CATCH_UP:
            self._wall += behind - CATCH_UP
            self.slipped += behind - CATCH_UP
        self.furthest_behind = max(self.furthest_behind, behind)
        return max(-behind, 0.0)
