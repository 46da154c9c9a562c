# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A node at its own pace, with stamps of the wall clock."""

from pathlib import Path
import time

from clock_teller import ClockTeller
from clock_teller import in_nanoseconds
from clock_teller import ros_time
from clock_teller import SeenFrames
from cloth_sim_interfaces.msg import TimeBase
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.sim.model.pose import Pose
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from made_again import assert_same
from node_process import NodeProcess
from player_process import PlayerProcess
import pytest
from recorded import Recorded
from rosgraph_msgs.msg import Clock
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from transform_teller import transform

NAME = '/walled/cloth_sim'
DT = round(PAUSED['dt'] * NANOSECONDS)


@pytest.fixture(scope='module')
def walled(tmp_path_factory, client):
    """Start a node beside the wall clock, paused."""
    values = {**PAUSED, 'time.epoch': 'wall'}
    begin = time.time_ns()
    with NodeProcess(tmp_path_factory.mktemp('walled'), values, '-r', '__ns:=/walled'):
        cloth = ClothUnderTest(client, values, NAME)
        cloth.begin = begin
        yield cloth


def stats_after(cloth, steps):
    """Return the statistics after ``steps`` steps, as they came first."""
    return cloth.wait_for('stats', lambda stats: stats.steps == steps)


def test_stamps_are_those_of_the_wall_clock(walled):
    """Beside a real robot, tf2 would find no time at which it knows tool and cloth."""
    walled.clear()
    assert walled.call(Trigger, 'reset').success
    asked = time.time_ns()
    assert walled.call(Step, 'step', steps=6).success
    stamp = in_nanoseconds(stats_after(walled, 6).header.stamp)
    base = walled['inputs/time_base'][-1]
    assert stamp >= asked
    assert stamp <= time.time_ns() + 6 * DT
    assert base.source == TimeBase.OWN
    assert walled.begin <= in_nanoseconds(base.epoch) <= stamp - 6 * DT


def test_time_goes_on_while_paused_and_reset(walled, client):
    """Beside a robot that moves on, tf2 would no longer find a cloth that stands still."""
    assert walled.call(Trigger, 'reset').success
    assert walled.call(Step, 'step', steps=2).success
    first = in_nanoseconds(stats_after(walled, 2).header.stamp)
    walled.clear()
    walled.wait_for('points', lambda cloud: (
        in_nanoseconds(cloud.header.stamp) > first + NANOSECONDS))
    walled.wait_for('tf', lambda message: (
        in_nanoseconds(message.transforms[0].header.stamp) > first + NANOSECONDS))
    assert walled.call(Trigger, 'reset').success
    walled.wait_for('inputs/command')
    assert walled.call(Step, 'step', steps=1).success
    stats_after(walled, 1)
    stamps = [in_nanoseconds(cloud.header.stamp) for cloud in walled['points']]
    assert stamps == sorted(stamps)
    # The topic is everybody's: nodes of other tests have stamps that begin at 0.
    stamps = [in_nanoseconds(array.header.stamp) for array in walled['diagnostics']]
    stamps = [stamp for stamp in stamps if stamp > first // 2]
    assert stamps and stamps == sorted(stamps) and stamps[0] >= first


def test_tools_and_pins_are_found_together(walled, client):
    """A robot could not be led to a pin."""
    assert walled.call(Trigger, 'reset').success
    assert walled.call(SetBool, 'pause', data=False).success
    tf = client.node.create_publisher(TFMessage, '/tf', 100)
    told = []
    pin = 'walled_cloth_sim_pin_0_0'
    begin = time.time_ns()
    walled.clear()

    def is_far():
        told.append(transform('tool0', 'world', Pose((0.0, 0.0, 1.0))))
        told[-1].header.stamp = ros_time(time.time_ns())
        tf.publish(TFMessage(transforms=told[-1:]))
        return any(
            each.child_frame_id == pin and in_nanoseconds(each.header.stamp) > begin + NANOSECONDS
            for message in walled['tf'] for each in message.transforms)

    client.spin_until(is_far, 'the cloth moves in that time')
    assert walled.call(SetBool, 'pause', data=True).success
    places = SeenFrames([TFMessage(transforms=told), *walled['tf']])
    for moment in (None, begin + NANOSECONDS // 2):
        assert places.pose('tool0', pin, moment).position == pytest.approx(
            [a - b for a, b in zip((0.0, 0.0, 1.0), places.pose(pin, 'world', moment).position)])
    client.node.destroy_publisher(tf)


def test_a_recording_has_that_time_and_runs_again(walled, client, tmp_path):
    """A bag of a robot and that of its cloth could not be laid side by side."""
    assert walled.call(Trigger, 'reset').success
    begin = time.time_ns()
    path = Path(walled.call(StartRecording, 'start_recording', name='walled').path)
    assert walled.call(Step, 'step', steps=8).success
    walled.clear()
    walled.wait_for('points')
    assert walled.call(Step, 'step', steps=8).success
    assert walled.call(Trigger, 'reset').success
    assert walled.call(Step, 'step', steps=4).success
    assert walled.call(Trigger, 'stop_recording').success
    entries = Recorded(path).entries
    times = [log_time for _, log_time, _ in entries]
    assert times == sorted(times) and times[0] >= begin
    for topic, log_time, message in entries:
        if hasattr(message, 'header') and topic.startswith(NAME) and 'topology' not in topic:
            assert in_nanoseconds(message.header.stamp) == log_time, topic
    stats = Recording(path).arrays('stats')
    assert stats['time'] == pytest.approx([0.0, 0.04, 0.08, 0.08, 0.1])
    assert stats['sim_time'] == pytest.approx([0.0, 0.04, 0.08, 0.0, 0.02])
    assert_same(path, node=NAME)
    # Played, the clock is that of the wall.
    with PlayerProcess(tmp_path, path, '--clock', '--paused', '--delay', 0) as player:
        clock = client.watch(Clock, '/clock')
        player.resume(client)
        assert player.wait(client) == 0
        assert len(clock.messages) >= 3
        assert all(in_nanoseconds(message.clock) >= begin for message in clock.messages)


def test_use_sim_time_beside_its_own_time_is_said(walled, client):
    """Log and parameters would have another time than the cloth, and nobody would know why."""
    with ClockTeller(client, 5 * NANOSECONDS) as clock:
        assert walled.set_parameters(use_sim_time=True).successful
        found = clock.tell_until(lambda: [
            status for array in walled['diagnostics'] for status in array.status
            if 'set time.source: ros to follow it' in status.message], 'a word of it')
    assert 'this one has use_sim_time and its own time' in found[0].message
    assert walled.set_parameters(use_sim_time=False).successful
