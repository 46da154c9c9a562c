# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording that is played in the view. Needs no ROS."""

from bisect import bisect_right
import math
from pathlib import Path
from threading import Lock
import time

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.input_history import MODE_KEYS
from cloth_sim_ros.analysis.input_history import ModeHistory
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.view.source import Moment
from cloth_sim_ros.view.source import PAUSED
from cloth_sim_ros.view.source import RUNNING
from cloth_sim_ros.view.source import Source

# What frames may take in memory [bytes]; of a larger recording every second, third ... is kept.
MOST_BYTES = 2**29


class RecordingSource(Source):
    """
    Plays a recording at the pace of its simulated time, and goes to any moment of it.

    :param path: folder or file
    :param node: name of the recorded node; None finds it
    :raises ClothSimError: when there is no frame to show
    """

    def __init__(
            self, path: str | Path, node: str | None = None, *,
            most_bytes: int = MOST_BYTES) -> None:
        """Read the frames."""
        recording = Recording(path, node)
        self.name = recording.name
        self._modes = ModeHistory()
        for entry in recording.entries(*MODE_KEYS):
            self._modes.read(entry)
        self._frames: list[Frame] = []
        stride = 1
        for number, frame in enumerate(read_frames(recording)):
            if number == 0:
                stride = max(1, math.ceil(
                    recording.count('points') * frame.records.nbytes / most_bytes))
            if number % stride == 0:
                self._frames.append(frame)
        if not self._frames:
            raise recording.no_frame()
        self._times = [frame.time for frame in self._frames]
        self._begin, self._end = self._times[0], self._times[-1]
        self.span = (self._begin, self._end)
        self.problems = recording.problems
        self._lock = Lock()
        self._is_paused = False
        self._begin_at(self._begin)

    def latest(self) -> Moment:
        """Return the moment that is played now."""
        with self._lock:
            now = self._now()
            if now >= self._end:
                self._is_paused = True
                self._begin_at(self._end)
            index = max(bisect_right(self._times, now + 1e-9) - 1, 0)
            run_state = PAUSED if self._is_paused else RUNNING
        frame = self._frames[index]
        return Moment(frame, self._modes.at(frame.time), run_state)

    def set_paused(self, is_paused: bool) -> None:
        """Stop, or go on; at the end, begin again."""
        with self._lock:
            now = self._now()
            is_at_end = not is_paused and now >= self._end
            self._begin_at(self._begin if is_at_end else now)
            self._is_paused = is_paused

    def go_to(self, time: float) -> None:
        """Show the moment at ``time`` [s], and stay there."""
        with self._lock:
            self._is_paused = True
            self._begin_at(min(max(time, self._begin), self._end))

    def close(self) -> None:
        """Forget the frames."""
        self._frames = self._frames[:1]
        self._times = self._times[:1]

    def _now(self) -> float:
        passed = 0.0 if self._is_paused else time.monotonic() - self._wall
        return min(self._time + passed, self._end)

    def _begin_at(self, moment: float) -> None:
        self._time, self._wall = moment, time.monotonic()
