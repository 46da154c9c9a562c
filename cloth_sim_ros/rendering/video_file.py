# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
        from cloth_sim_ros.rendering.av_video import AvVideo
    except ImportError:
        program = shutil.which('ffmpeg')
        if program is None:
            raise ClothSimError(
                'no video encoder was found: run `pip install av`, or install ffmpeg')
        from cloth_sim_ros.rendering.ffmpeg_video import FfmpegVideo
        return FfmpegVideo(program, path, size, fps)
    return AvVideo(path, size, fps)
