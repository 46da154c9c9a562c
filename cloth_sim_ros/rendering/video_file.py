# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Write a video file, with what is there to encode it."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
import shutil
import subprocess
from tempfile import TemporaryFile
from typing import Protocol

from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

# The best first; each with the options for good quality.
_CODECS = {'libx264': ['-crf', '18'], 'libopenh264': [], 'mpeg4': ['-q:v', '2']}


class FfmpegVideo:
    """
    A video file.

    :param program: path of ffmpeg
    :param size: width and height [pixel], both even
    """

    def __init__(
            self, program: str, path: str | Path, size: tuple[int, int], fps: float) -> None:
        """Start the program."""
        known = subprocess.run(
            [program, '-hide_banner', '-encoders'], capture_output=True, text=True).stdout.split()
        codec = next((name for name in _CODECS if name in known), 'mpeg4')
        self._complaints = TemporaryFile()
        self._process = subprocess.Popen(
            [program, '-hide_banner', '-loglevel', 'error', '-y', '-f', 'rawvideo',
             '-pixel_format', 'rgb24', '-video_size', f'{size[0]}x{size[1]}',
             '-framerate', str(fps), '-i', '-', '-c:v', codec, *_CODECS[codec],
             '-pix_fmt', 'yuv420p', Path(path).absolute()],
            stdin=subprocess.PIPE, stderr=self._complaints)

    def write(self, image: np.ndarray) -> None:
        """Append ``image``, (height, width, 3) uint8; OSError when it can't."""
        assert self._process.stdin is not None  # a pipe
        try:
            self._process.stdin.write(np.ascontiguousarray(image).data)
        except BrokenPipeError:
            # What went wrong is told on closing.
            self.close()

    def close(self) -> None:
        """Finish the file; OSError with what the program said when it failed."""
        if self._complaints.closed:
            return
        try:
            self._process.communicate()
            self._complaints.seek(0)
            said = self._complaints.read().decode(errors='replace').strip()
        finally:
            self._complaints.close()
        if self._process.returncode:
            raise OSError(said.splitlines()[-1] if said else 'ffmpeg failed')


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
        return FfmpegVideo(program, path, size, fps)
    return AvVideo(path, size, fps)
