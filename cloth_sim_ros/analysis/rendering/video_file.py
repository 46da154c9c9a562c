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

"""Write a video file, with what is there to encode it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
import shutil
from typing import Protocol

from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np


class VideoWriter(Protocol):
    """Encodes images, one after the other."""

    def write(self, image: np.ndarray) -> None:
        """Append ``image``, (height, width, 3) uint8."""

    def close(self) -> None:
        """Finish the file."""


@contextmanager
def open_video(
        path: str | Path, size: tuple[int, int], fps: float) -> Iterator[VideoWriter]:
    """
    Open a video to write images into; it is finished however the block ends.

    :param size: width and height [pixel], both even
    :raises ClothSimError: when nothing here encodes video, or the file can't be written
    """
    try:
        video = _make_video(path, size, fps)
        try:
            yield video
        finally:
            video.close()
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def _make_video(path: str | Path, size: tuple[int, int], fps: float) -> VideoWriter:
    try:
        from cloth_sim_ros.analysis.rendering.av_video import AvVideo
    except ImportError:
        program = shutil.which('ffmpeg')
        if program is None:
            raise ClothSimError(
                'no video encoder was found: run `pip install av`, or install ffmpeg')
        from cloth_sim_ros.analysis.rendering.ffmpeg_video import FfmpegVideo
        return FfmpegVideo(program, path, size, fps)
    return AvVideo(path, size, fps)
