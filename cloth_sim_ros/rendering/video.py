# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A video of the cloth, of one recording or of several side by side."""

from collections.abc import Iterator
from collections.abc import Sequence
from contextlib import contextmanager
import math
from pathlib import Path
import shutil
import subprocess
from tempfile import TemporaryFile
from typing import Any
from typing import Protocol

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.renderer import has_bar
from cloth_sim_ros.rendering.renderer import labels_of
from cloth_sim_ros.rendering.renderer import note_of
from cloth_sim_ros.rendering.renderer import Stage
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.renderer import title_of
from cloth_sim_ros.rendering.sheet import Layout
from cloth_sim_ros.rendering.source import nearest_frames
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np
from tqdm import tqdm

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
            # close() raises the error of the program.
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


_SIZE = (1280, 720)   # of the whole video, of each column and row where there are several [pixel]
_SMALLER = (640, 600)
_MOST_FPS = 1000.0


def write_video(
        sources: Sequence[Source], path: str | Path, *, style: Style = Style(),
        fps: float = 30.0, speed: float = 1.0, begin: float | None = None,
        end: float | None = None) -> None:
    """
    Draw ``sources`` over time, side by side, and write the video to ``path``.

    They are read twice, first to find the camera and the scale; frames are never kept.

    :param sources: at least one
    :param fps: images a second
    :param speed: simulated seconds in a second of the video
    :param begin: [s], None is the first frame
    :param end: [s], None is the last frame
    :raises ClothSimError: when there is no frame, or no video can be written
    """
    if not 0.0 < fps <= _MOST_FPS:
        raise ClothSimError(f'--fps must be above 0 and at most {_MOST_FPS:g}, got {fps:g}')
    if not 0.0 < speed < math.inf:
        raise ClothSimError(f'--speed must be above 0, got {speed:g}: 0.5 is slow motion')
    survey = Survey()
    firsts, times = _look_through(sources, survey, begin, end)
    begin, end = times
    columns = min(len(sources), style.columns)
    title = title_of(sources, firsts) if style.title is None else style.title
    scale = StrainScale(survey.strains, style.strain_max)
    parts: dict[str, Any] = {
        'rows': -(-len(sources) // columns), 'columns': columns, 'has_title': bool(title),
        'has_bar': has_bar(scale, style)}
    layout = Layout(panel=style.panel, **parts) if style.panel else _usual_layout(parts)
    count = math.floor((end - begin) * fps / speed + 1e-6) + 1
    names = labels_of(sources, style) if len(sources) > 1 or style.labels else ['']
    with open_video(path, layout.size, fps) as video:
        stage = Stage(
            survey, scale, layout, style.camera, title=title, note=note_of(sources),
            look=style.look)
        try:
            before: list[Frame] = []
            bar = tqdm(
                _in_step(sources, begin, speed / fps, count), total=count, desc='drawing',
                unit='image', disable=None)
            for frames in bar:
                # In slow motion many images are the same.
                if any(a is not b for a, b in zip(frames, before)) or not before:
                    image = stage.draw(frames, [
                        ', '.join(filter(None, (name, f't = {frame.time:.2f} s')))
                        for name, frame in zip(names, frames)])
                video.write(image)
                before = frames
        finally:
            stage.close()


def _look_through(
        sources: Sequence[Source], survey: Survey, begin: float | None,
        end: float | None) -> tuple[list[Frame], tuple[float, float]]:
    """Show all frames to ``survey``; return the first of each source, and begin and end [s]."""
    firsts, last = [], -math.inf
    with tqdm(desc='reading', unit='frame', disable=None) as bar:
        for source in sources:
            frame = None
            for number, frame in enumerate(source.frames()):
                if number == 0:
                    firsts.append(frame)
                last = max(last, frame.time)
                bar.update()
                if end is not None and frame.time > end:
                    break
                if begin is None or frame.time >= begin:
                    survey.add(frame)
    first = min(frame.time for frame in firsts)
    begin = first if begin is None else max(begin, first)
    end = last if end is None else min(end, last)
    if end < begin or not survey.frames:
        raise ClothSimError(
            f'there is no frame from {begin:g} to {end:g} s: give --from and --to between '
            f'{first:g} and {last:g}')
    return firsts, (begin, end)


def _in_step(
        sources: Sequence[Source], begin: float, step: float,
        count: int) -> Iterator[list[Frame]]:
    streams = [
        nearest_frames(source.frames(), (begin + number * step for number in range(count)))
        for source in sources]
    for _ in range(count):
        yield [next(stream) for stream in streams]


def _usual_layout(parts: dict[str, Any]) -> Layout:
    rows, columns = parts['rows'], parts['columns']
    if rows * columns == 1:
        return Layout.within(*_SIZE, **parts)
    return Layout.within(_SMALLER[0] * columns, _SMALLER[1] * rows, **parts)
