# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A video of the cloth, of one recording or of several side by side."""

import os
from pathlib import Path
import subprocess
import sys

import av
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.sheet import Layout
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.video import open_video
from cloth_sim_ros.rendering.video import write_video
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np
import pytest

GREYS = (0, 60, 120, 180, 240)
_WITHOUT_AV = f"""
import sys
sys.modules['av'] = None
from cloth_sim_ros.rendering.video import open_video
import numpy as np
with open_video(sys.argv[1], (64, 48), 10.0) as video:
    for grey in {GREYS}:
        video.write(np.full((48, 64, 3), grey, np.uint8))
"""


def write(video):
    """Write an image for each of GREYS."""
    for grey in GREYS:
        video.write(np.full((48, 64, 3), grey, np.uint8))


def check(path):
    """Decode a video, and compare it with what was written."""
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert float(stream.average_rate) == 10.0
        images = [frame.to_ndarray(format='rgb24') for frame in container.decode(stream)]
    assert [image.shape for image in images] == 5 * [(48, 64, 3)]
    np.testing.assert_allclose([image.mean() for image in images], GREYS, atol=3.0)


def test_what_is_written_can_be_decoded(tmp_path):
    """No player would show it, or in other colours."""
    with open_video(tmp_path / 'greys.mp4', (64, 48), 10.0) as video:
        write(video)
    check(tmp_path / 'greys.mp4')


def test_an_interrupted_video_can_be_played(tmp_path):
    """After Ctrl-C the images so far would be lost."""
    with pytest.raises(KeyboardInterrupt):
        with open_video(tmp_path / 'greys.mp4', (64, 48), 10.0) as video:
            write(video)
            raise KeyboardInterrupt
    check(tmp_path / 'greys.mp4')


@pytest.mark.parametrize(('name', 'rule'), [
    ('nowhere/run.mp4', 'nowhere/run.mp4 cannot be written'),
    ('run.txt', r'run.txt .*name it \*.mp4'), ('run', r'name it \*.mp4')])
def test_a_file_that_cannot_be_written_is_told(tmp_path, name, rule):
    """A user would get a traceback of the encoder."""
    with pytest.raises(ClothSimError, match=rule):
        with open_video(tmp_path / name, (64, 48), 10.0) as video:
            write(video)


def write_without_av(path, programs):
    """Write GREYS in a process that finds only ``programs``."""
    return subprocess.run(
        [sys.executable, '-c', _WITHOUT_AV, path], capture_output=True, text=True,
        env={**os.environ, 'PATH': str(programs)})


def test_without_an_encoder_the_way_out_is_told(tmp_path):
    """A user would get an ImportError."""
    done = write_without_av(tmp_path / 'run.mp4', tmp_path)
    assert done.stderr.splitlines()[-1].endswith(
        'no video encoder was found: run `pip install av`, or install ffmpeg')


@pytest.mark.long
def test_the_program_ffmpeg_will_do(tmp_path: Path):
    """A machine with ffmpeg and without PyAV would make no videos."""
    subprocess.run(
        [sys.executable, '-m', 'pip', 'install', '-q', '--no-deps', '--target', tmp_path,
         'imageio-ffmpeg==0.8.1'], check=True)
    program, = (tmp_path / 'imageio_ffmpeg' / 'binaries').glob('ffmpeg-*')
    programs = tmp_path / 'programs'
    programs.mkdir()
    (programs / 'ffmpeg').symlink_to(program)
    done = write_without_av(tmp_path / 'greys.mp4', programs)
    assert done.returncode == 0, done.stderr
    check(tmp_path / 'greys.mp4')
    done = write_without_av(tmp_path / 'nowhere' / 'greys.mp4', programs)
    assert 'greys.mp4 cannot be written: ' in done.stderr.splitlines()[-1]
    assert 'No such file' in done.stderr.splitlines()[-1]


# Videos: what is written can be decoded again, and shows the run.

SMALL = Style(panel=(160, 120))


@pytest.fixture
def source(known):
    """Return the known recording: 25 frames from 0 to 0.48 s."""
    return RecordingSource(Recording(known.folder))


def decoded(path):
    """Return the images of a video, and its rate."""
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        rate = float(stream.average_rate)
        return [frame.to_ndarray(format='rgb24') for frame in container.decode(stream)], rate


def test_it_shows_the_whole_run_at_its_pace(source, tmp_path):
    """A video would be too short, too fast, or of another size."""
    write_video([source], tmp_path / 'run.mp4', style=SMALL, fps=25.0)
    images, rate = decoded(tmp_path / 'run.mp4')
    assert rate == 25.0
    assert len(images) == 13  # 0.48 s at 25 images a second, both ends
    assert {image.shape[1::-1] for image in images} == {Layout(1, 1, SMALL.panel).size}
    # The cloth of the known recording moves in every frame.
    for before, after in zip(images, images[1:]):
        assert np.abs(after.astype(int) - before).max() > 40


def test_slow_motion_has_more_images(source, tmp_path):
    """The pace could not be chosen."""
    write_video(
        [source], tmp_path / 'slow.mp4', style=SMALL, fps=20.0, speed=0.25, begin=0.1, end=0.2)
    assert len(decoded(tmp_path / 'slow.mp4')[0]) == 9


def test_several_recordings_run_side_by_side(source, tmp_path):
    """Two runs could not be compared while they move."""
    write_video(
        [source, source], tmp_path / 'two.mp4', style=SMALL, fps=10.0, end=0.2)
    images, _ = decoded(tmp_path / 'two.mp4')
    layout = Layout(1, 2, SMALL.panel)
    assert len(images) == 3
    assert images[0].shape[1::-1] == layout.size
    lefts = [layout.corner(number)[0] for number in range(2)]
    halves = [images[2][30:, left:left + 160].astype(int) for left in lefts]
    assert np.abs(halves[0] - halves[1]).mean() < 6.0


def test_by_itself_a_video_has_the_size_of_a_screen(source, tmp_path):
    """Players would scale it."""
    write_video([source], tmp_path / 'run.mp4', fps=1.0)
    assert decoded(tmp_path / 'run.mp4')[0][0].shape == (720, 1280, 3)


@pytest.mark.parametrize(('arguments', 'rule'), [
    ({'fps': 0.0}, '--fps must be above 0'), ({'speed': 0.0}, '--speed must be above 0'),
    ({'speed': float('nan')}, '--speed'), ({'begin': 3.0}, 'no frame from 3 to 0.48 s'),
    ({'end': -1.0}, 'no frame from 0 to -1 s'), ({'begin': 0.3, 'end': 0.1}, 'no frame'),
])
def test_what_cannot_be_shown_is_refused(source, tmp_path, arguments, rule):
    """An empty video would be left behind."""
    with pytest.raises(ClothSimError, match=rule):
        write_video([source], tmp_path / 'no.mp4', style=SMALL, **arguments)
    assert not (tmp_path / 'no.mp4').exists()
