# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""When each message of a recording is due on the wall clock."""

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
        """Tell whether nothing is due."""
        return self._paused_at is not None

    def pause(self, wall: float) -> None:
        """Stand still from ``wall`` on."""
        if self._paused_at is None:
            self._paused_at = wall

    def resume(self, wall: float) -> None:
        """Go on from where the clock stood."""
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
