# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which library writes recordings, and what is said where there is none."""

from importlib.metadata import files
from importlib.util import find_spec
import os
from pathlib import Path
import subprocess
import sys
import sysconfig

from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_writer import BagWriter
from cloth_sim_ros.recording.rosbag2_limits import check_options
from cloth_sim_ros.recording.writer_choice import chosen_library
from cloth_sim_ros.recording.writer_choice import library_report
from cloth_sim_ros.recording.writer_choice import open_writer
from cloth_sim_ros.sim.errors import ClothSimError
import pytest

ROOT = Path(__file__).resolve().parents[2]
RECORD = """
import sys
sys.path[:0] = [{root!r}]
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.sim.errors import ClothSimError
session = RecordingSession({folder!r}, 'cloth_sim', print)
print(repr(session.library))
try:
    session.start('run')
except ClothSimError as error:
    print(error)
"""


@pytest.mark.parametrize(('there', 'chosen'), [
    ({'mcap', 'rosbag2_py'}, 'mcap'), ({'mcap'}, 'mcap'), ({'rosbag2_py'}, 'rosbag2_py'),
    (set(), '')])
def test_mcap_is_taken_first(there, chosen):
    """A node in a sourced ROS would refuse to record, or lose more when it is killed."""
    assert chosen_library(there.__contains__) == chosen


def test_here_mcap_writes(tmp_path):
    """The choice would not be what writes."""
    assert chosen_library() == 'mcap' and not library_report('mcap')
    writer = open_writer('mcap', tmp_path, RecordingOptions())
    assert isinstance(writer, BagWriter)
    writer.finish()


@pytest.mark.parametrize('library', ['rosbag2_py', ''])
def test_another_choice_is_said(library):
    """A user would wonder why recordings are otherwise, or refused."""
    said = library_report(library)
    assert 'mcap' in said and 'rosbag2_py' in said and 'pip install mcap' in said


@pytest.mark.parametrize(('options', 'setting'), [
    (RecordingOptions(max_size=1000), 'recording.max_size is 1000'),
    (RecordingOptions(fsync=True), 'recording.fsync is true')])
def test_what_rosbag2_lacks_is_refused(options, setting):
    """A limit that was asked for would be passed silently."""
    with pytest.raises(ClothSimError, match=setting):
        check_options(options)
    check_options(RecordingOptions(max_bagfile_size=10**6, max_bagfile_duration=1.0))


def test_without_either_it_is_refused(tmp_path):
    """A node of a user without mcap would end with a traceback, or leave an empty folder."""
    if find_spec('rosbag2_py') is not None:
        pytest.skip('a ROS with rosbag2_py is sourced, which records without mcap')
    packages = tmp_path / 'packages'
    packages.mkdir()
    # The same packages, without the files that mcap has installed.
    left_out = {Path(file).parts[0] for file in files('mcap')}
    for path in Path(sysconfig.get_path('purelib')).iterdir():
        if path.name not in left_out and path.suffix != '.pth':
            (packages / path.name).symlink_to(path)
    environment = {**os.environ, 'PYTHONPATH': str(packages)}
    code = (f'import sys; sys.path[:] = [path for path in sys.path if path != '
            f'{sysconfig.get_path("purelib")!r}]\n') + RECORD.format(
                root=str(ROOT), folder=str(tmp_path / 'bags'))
    printed = subprocess.run(
        [sys.executable, '-c', code], env=environment, capture_output=True, text=True,
        timeout=120, check=False)
    assert printed.stdout.splitlines()[0] == "''", printed.stderr
    assert 'mcap, which reads and writes recordings, is missing' in printed.stdout
    assert 'rosbag2_py' in printed.stdout
    assert not list((tmp_path / 'bags').glob('*'))
