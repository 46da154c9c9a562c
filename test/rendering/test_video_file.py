# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What encodes a video, and what is said where nothing does."""

import os
from pathlib import Path
import subprocess
import sys

import av
from cloth_sim_ros.rendering.video_file import open_video
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np
import pytest

GREYS = (0, 60, 120, 180, 240)
_WITHOUT_AV = f"""
import sys
sys.modules['av'] = None
from cloth_sim_ros.rendering.video_file import open_video
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
