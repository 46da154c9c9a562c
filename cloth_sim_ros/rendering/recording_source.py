# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of a recording, to draw."""

from collections.abc import Iterator
from collections.abc import Sequence
from functools import cached_property

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.frames import default_times
from cloth_sim_ros.analysis.frames import frames_at
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.rendering.source import Source


class RecordingSource(Source):
    """The cloth of ``recording``."""

    def __init__(self, recording: Recording) -> None:
        """Keep the recording, without reading it."""
        self._recording = recording
        path = recording.path.resolve()
        self.name = path.stem if path.is_file() else path.name

    @property
    def modes(self) -> list[str]:
        """Get the simulation modes, in the order they came; none when that is not known."""
        return self._told[0]

    @property
    def device(self) -> str:
        """Name the device that simulated it; empty when that is not known."""
        return self._told[1]

    @property
    def missing(self) -> list[str]:
        """Name what can't be drawn: nothing, since a frame without it is refused."""
        return []

    def frames(self) -> Iterator[Frame]:
        """Yield every frame; ClothSimError when there is none."""
        is_empty = True
        for frame in read_frames(self._recording):
            is_empty = False
            yield frame
        if is_empty:
            raise self._recording.no_frame()

    def frames_at(self, times: Sequence[float]) -> list[Frame]:
        """Return the frame nearest to each of ``times`` [s], which grow."""
        return frames_at(self._recording, times)

    def default_times(self, count: int) -> list[float]:
        """Return ``count`` times [s] that show what happens."""
        return default_times(self._recording, count)

    @cached_property
    def _told(self) -> tuple[list[str], str]:
        modes: list[str] = []
        device = ''
        for entry in self._recording.entries('inputs/mode', 'state'):
            if entry.key == 'state':
                device = entry.message.device
            elif entry.message.mode not in modes:
                modes.append(entry.message.mode)
        return modes, device
