# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recordings that claim more than they hold."""

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import PinChange
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.resimulation.rerun_limits import MOST_FRAMES
from cloth_sim_ros.sim.errors import ClothSimError
from made_again import Director
from made_again import made_again
from made_cloud import make_cloud
import pytest
from rclpy.serialization import serialize_message
from std_msgs.msg import Header

LATEST = 2**31 - 1  # [s] that a stamp can have


def at(sec, nanosec=0):
    """Return a header of this time."""
    return Header(stamp=Time(sec=sec, nanosec=nanosec))


def refusal_of(path, **changes):
    """Return the words with which a recording is refused."""
    with pytest.raises(ClothSimError) as error:
        with made_again(path, **changes):
            pass
    return str(error.value)


@pytest.mark.parametrize(('key', 'message'), [
    ('stats', ClothStats(header=at(LATEST))),
    ('inputs/command', Command(header=at(LATEST), command='clear_pushes')),
    ('stats', ClothStats(header=at(3)))], ids=['frame', 'input', 'some seconds'])
def test_a_stamp_far_ahead_is_refused(tmp_path, key, message):
    """Sixty-eight years would be simulated for one wrong byte."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(4)
        director.send(key, message)
    assert f'has a message on ~/{key} of ' in (words := refusal_of(director.path))
    assert 'after one of 0.02 s, and at 50 frames per second' in words


def test_the_longest_gap_that_frames_may_have_is_made(tmp_path):
    """A recording that lacks some frames could not be made again."""
    with Director(tmp_path, {'rows': 2, 'cols': 2}) as director:
        director.step(4 * MOST_FRAMES)
    with made_again(director.path) as rerun:
        assert rerun.check.equal == rerun.check.frames == 2


def test_a_recording_without_frames_may_be_silent_for_long(tmp_path):
    """A run whose topics were switched off could not be made again."""
    with Director(tmp_path, {'rows': 2, 'cols': 2}) as director:
        director.send('inputs/parameters', parameters_message(
            {'publish.points': False, 'publish.stats': False}, FIELDS, 0.0, 'cloth_sim',
            is_change=True))
        director.simulation.step(4 * MOST_FRAMES + 400)
        director.send('inputs/command', Command(header=at(4), command='clear_pushes'))
    with made_again(director.path) as rerun:
        assert rerun.simulation.steps == 800


def recorded(folder, values, *messages):
    """Record parameters and what follows, serialised, all at the time 0."""
    recorder = Recorder(folder, 'made', 'cloth_sim')
    recorder.write('inputs/parameters', serialize_message(
        parameters_message(values, FIELDS, 0.0, 'cloth_sim')), 0.0)
    for key, data in messages:
        recorder.write(key, data, 0.0)
    recorder.close()
    return recorder.path


def test_more_nodes_than_a_cloud_has_are_refused(tmp_path):
    """A few bytes would take gigabytes of the device."""
    path = recorded(
        tmp_path, {'rows': 2048, 'cols': 2048}, ('points', make_cloud(8, 8, 0)[0]))
    words = refusal_of(path)
    assert '2048 x 2048 nodes and clouds of 8 x 8: give --set rows' in words
    with made_again(path, rows=8, cols=8) as rerun:
        assert rerun.check.frames == 1


def test_many_nodes_without_a_cloud_have_to_be_asked_for(tmp_path):
    """A few bytes would take gigabytes of the device."""
    stats = serialize_message(ClothStats())
    path = recorded(tmp_path, {'rows': 8192, 'cols': 8192}, ('stats', stats))
    assert '8192 x 8192 nodes but no cloud' in refusal_of(path)


def test_a_beginning_before_zero_is_refused(tmp_path):
    """Steps would be counted from below zero, and the shaders get what is none."""
    recorder = Recorder(tmp_path, 'made', 'cloth_sim')
    message = parameters_message({'rows': 8, 'cols': 8}, FIELDS, 0.0, 'cloth_sim')
    message.stamp = Time(sec=-5)
    recorder.write('inputs/parameters', serialize_message(message), 0.0)
    recorder.close()
    assert 'begins at -5 s, before 0' in refusal_of(recorder.path)


def test_a_pin_outside_the_cloth_is_refused_at_the_beginning(tmp_path):
    """A recording from the middle of a run would end as a traceback."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}, lambda cloth: cloth.step(3)) as director:
        pass
    # What holds at the beginning stands before the first frame.
    recorder = Recorder(tmp_path, 'outside', 'cloth_sim')
    for message in BagReader(director.path).messages():
        key = message.topic.removeprefix('/cloth_sim/')
        if key.startswith('/'):
            continue
        recorder.write(key, message.data, 0.0)
        if key == 'inputs/parameters':
            recorder.write('inputs/pin', serialize_message(PinChange(
                header=at(0, 15_000_000), row=2**32 - 1, col=3, pinned=True)), 0.0)
    recorder.close()
    assert 'a pin at node (4294967295, 3), and the cloth has 8 x 9' in refusal_of(recorder.path)
