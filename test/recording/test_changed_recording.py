# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What other programs do to a recording that is being written."""

import os
import shutil
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.recording.recording_faults import RecordingError
import pytest
from rclpy.serialization import serialize_message
import yaml

PATIENCE = 300.0  # wall time; two seconds do on a machine that is not busy


@pytest.fixture
def recorder(tmp_path):
    """Return a recorder whose first 20 messages are flushed."""
    recorder = Recorder(tmp_path, 'run')
    send(recorder, 20)
    while count(recorder.path / 'metadata.yaml') < 20:
        time.sleep(0.02)
    yield recorder
    try:
        recorder.close()
    except RecordingError:
        pass


def send(recorder, number):
    """Record so many messages."""
    for step in range(number):
        recorder.write('stats', serialize_message(ClothStats(steps=step)), step / 50)


def count(metadata):
    """Return the number of messages that metadata.yaml has."""
    content = yaml.safe_load(metadata.read_text())
    return content['rosbag2_bagfile_information']['message_count']


def end_of(recorder):
    """Return how the recording ends; nothing is written to it meanwhile."""
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline:
        try:
            recorder.check()
        except RecordingError as error:
            return str(error)
        time.sleep(0.02)
    return 'no end'


def remove(file):
    """Take the file away."""
    file.unlink()


def truncate(file):
    """Leave a part of the file."""
    os.truncate(file, file.stat().st_size - 100)


def extend(file):
    """Write behind the end of the file."""
    with file.open('ab') as stream:
        stream.write(b'of another program')


def replace(file):
    """Replace the file by a copy."""
    shutil.copy(file, file.with_name('copy'))
    file.with_name('copy').replace(file)


def remove_folder(file):
    """Take the whole folder away."""
    shutil.rmtree(file.parent)


def replace_linked(file):
    """Replace the file by a copy; the file keeps another name."""
    os.link(file, file.with_name('linked'))
    replace(file)


def move_folder(file):
    """Give the folder another name."""
    file.parent.rename(file.parent.with_name('elsewhere'))


CHANGES = {
    remove: 'run_0.mcap was removed or replaced by another program',
    truncate: 'run_0.mcap was truncated by another program, from',
    extend: 'another program has written to run_0.mcap',
    replace: 'run_0.mcap was removed or replaced by another program',
    replace_linked: 'run_0.mcap was removed or replaced by another program',
    remove_folder: 'run_0.mcap was removed or replaced by another program',
    move_folder: 'run_0.mcap is no longer in its folder (No such file or directory)',
}


@pytest.mark.parametrize('change', CHANGES)
def test_change_is_reported_without_a_write(recorder, change):
    """A run of hours would record into a file that was moved or removed."""
    change(recorder.path / 'run_0.mcap')
    reason = end_of(recorder)
    assert CHANGES[change] in reason
    assert reason.startswith(f'recording to {recorder.path} has stopped (')
    assert 'leave the folder of a recording alone' in reason and 'start a new one' in reason


@pytest.mark.parametrize('change', CHANGES)
def test_closing_reports_it_too(recorder, change):
    """A recording that is gone would be said to be closed."""
    change(recorder.path / 'run_0.mcap')
    with pytest.raises(RecordingError) as caught:
        recorder.close()
    assert CHANGES[change] in str(caught.value)
    recorder.close()


def test_what_is_left_of_a_truncated_file_is_read(recorder):
    """What comes after the cut would stand behind a hole, or behind half a record."""
    file = recorder.path / 'run_0.mcap'
    begin = file.read_bytes()[:-100]
    truncate(file)
    deadline = time.monotonic() + PATIENCE
    with pytest.raises(RecordingError):
        # It is noticed when the next message is written, or soon after.
        while time.monotonic() < deadline:
            send(recorder, 100)
            time.sleep(1e-2)
    assert file.read_bytes() == begin


def test_a_message_of_another_program_is_cut_off(recorder):
    """What was flushed could not be read for what somebody else has put behind it."""
    extend(recorder.path / 'run_0.mcap')
    assert end_of(recorder) != 'no end'
    assert sum(1 for _ in BagReader(recorder.path).messages()) == 20


def test_nobody_elses_file_is_touched(recorder):
    """A file that replaced the recording would be cut."""
    file = recorder.path / 'run_0.mcap'
    file.unlink()
    file.write_bytes(bytes(100_000))
    assert end_of(recorder) != 'no end'
    assert file.read_bytes() == bytes(100_000)


def test_a_lost_metadata_file_is_written_again(recorder):
    """A recording would end for a file that can be made again at any time."""
    (recorder.path / 'metadata.yaml').unlink()
    send(recorder, 5)
    recorder.close()
    assert count(recorder.path / 'metadata.yaml') == 25


def test_the_end_wakes_who_waits_for_it(tmp_path):
    """A paused node would report the end of its recording when it goes on, hours later."""
    woken = []
    recorder = Recorder(tmp_path, 'run', on_end=lambda: woken.append('ended'))
    (recorder.path / 'run_0.mcap').unlink()
    deadline = time.monotonic() + PATIENCE
    while not woken and time.monotonic() < deadline:
        time.sleep(0.01)
    assert woken == ['ended']
    with pytest.raises(RecordingError):
        recorder.close()
    whole = Recorder(tmp_path, 'whole', on_end=lambda: woken.append('closed'))
    whole.close()
    assert len(woken) == 1
