# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A node that follows the /clock of another program, in lockstep."""

from pathlib import Path

from builtin_interfaces.msg import Time
from clock_teller import ClockTeller
from clock_teller import in_nanoseconds
from clock_teller import ros_time
from clock_teller import SeenFrames
from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.sim.model.pose import Pose
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from foreign_bag import write_bag
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose as PoseMessage
from made_again import assert_same
from node_process import NodeProcess
from player_process import PlayerProcess
import pytest
from recorded import Recorded
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Header
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from transform_teller import transform

FOLLOWING = {**SCENE, 'time.source': 'ros', 'mode': 'mass_spring'}
NAME = '/followed/cloth_sim'
BEGIN = 1_000 * NANOSECONDS + 123_456_789
DT = round(SCENE['dt'] * NANOSECONDS)
PIN = 'followed_cloth_sim_pin_0_0'


@pytest.fixture
def start(tmp_path, client):
    """Return what starts a node beside a clock, and is given the cloth and the clock."""
    opened = []

    def begin(**values):
        parameters = {**FOLLOWING, **{
            name.replace('__', '.'): value for name, value in values.items()}}
        node = NodeProcess(tmp_path, parameters, '-r', '__ns:=/followed')
        opened.append(node)
        cloth = ClothUnderTest(client, parameters, NAME)
        clock = ClockTeller(client, BEGIN)
        opened.append(clock)
        return cloth, clock

    yield begin
    for each in reversed(opened):
        each.__exit__(None)


def follow(cloth, clock):
    """Have the node follow the clock from BEGIN on, and the mode compiled."""
    clock.tell_until(
        lambda: any(in_nanoseconds(base.epoch) for base in cloth['inputs/time_base']),
        'the node follows the clock')
    clock.tell_until(
        lambda: any(state.run_state == ClothState.RUNNING for state in cloth['state']), 'it runs')


def wait_for_steps(cloth, clock, steps):
    """Return the cloud after ``steps`` steps, with the clock standing still."""
    epoch = in_nanoseconds(cloth['inputs/time_base'][-1].epoch)
    stamp = epoch + steps * DT

    def found():
        return [cloud for cloud in cloth['points'] if in_nanoseconds(cloud.header.stamp) == stamp]

    return clock.tell_until(found, f'a cloud after {steps} steps')[-1]


def follows(array):
    """Return whether a message of /diagnostics is of a node that follows /clock."""
    return any(status.message == 'stamps follow /clock' for status in array.status)


def stamps_of(cloth):
    """Return the stamps of all that the node has said, by the topic [ns]."""
    found = {}
    for key in ('points', 'stats', 'state', 'pins/wrenches', 'inputs/time_base'):
        found[key] = [in_nanoseconds(message.header.stamp) for message in cloth[key]]
    # These topics are everybody's: nodes of other tests may be there, which follow no clock.
    found['diagnostics'] = [
        in_nanoseconds(array.header.stamp) for array in cloth['diagnostics'] if follows(array)]
    found['tf'] = [
        in_nanoseconds(each.header.stamp) for message in cloth['tf']
        for each in message.transforms if each.child_frame_id.startswith('followed_cloth_sim')]
    found['markers'] = [
        in_nanoseconds(marker.header.stamp) for array in cloth['markers']
        for marker in array.markers]
    found['inputs/parameters'] = [in_nanoseconds(event.stamp) for event in cloth[
        'inputs/parameters']]
    return found


def test_steps_with_a_slow_clock_and_halts(start):
    """Beside a simulator at a quarter of real time the cloth would run away, or run on."""
    cloth, clock = start()
    follow(cloth, clock)
    # Neither a multiple of dt nor of a frame.
    clock.run(0.5, 0.0037, 0.25)
    passed = clock.now - BEGIN
    steps = passed // DT
    assert passed % DT, 'halted between two steps'
    wait_for_steps(cloth, clock, steps)
    assert {in_nanoseconds(base.epoch) for base in cloth['inputs/time_base']} <= {0, BEGIN}
    # While it stands still, so does the cloth.
    count = sum(map(follows, cloth['diagnostics']))
    clock.tell_until(lambda: sum(map(follows, cloth['diagnostics'])) > count + 2,
                     'time goes on without it')
    assert max(stats.steps for stats in cloth['stats']) == steps
    assert all(
        in_nanoseconds(stats.header.stamp) == BEGIN + stats.steps * DT
        for stats in cloth['stats'] if stats.steps)


def test_all_stamps_are_of_one_base(start):
    """An aggregator, a viewer or tf2 would take a part of what the node says for stale."""
    cloth, clock = start()
    follow(cloth, clock)
    # What was published before the clock was known is stamped from 0, and may arrive late.
    clock.tell_until(
        lambda: all(max(stamps_of(cloth)[key], default=0) >= BEGIN for key in (
            'points', 'stats', 'tf', 'markers', 'pins/wrenches')), 'all topics are of its base')
    cloth.clear()
    clock.run(0.2, 0.01, 1.0)
    assert cloth.set_parameters(real_time_factor=1.0).successful
    clock.tell_until(
        lambda: any(map(follows, cloth['diagnostics'])), 'the health of the run')
    wait_for_steps_of = (clock.now - BEGIN) // DT
    clock.tell_until(lambda: any(
        stats.steps == wait_for_steps_of for stats in cloth['stats']), 'the last step')
    clock.tell_until(lambda: cloth['inputs/parameters'], 'the parameter that was set')
    for key, stamps in stamps_of(cloth).items():
        assert all(BEGIN <= stamp <= clock.now for stamp in stamps), key
        assert stamps or key in ('state', 'inputs/time_base'), key


def test_a_clock_that_goes_back_resets(start):
    """After a reset of the other simulator the cloth would wait for minutes."""
    cloth, clock = start()
    follow(cloth, clock)
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 20)
    cloth.clear()
    back = 7 * NANOSECONDS
    clock.tell_until(lambda: cloth['inputs/command'], 'the reset', back)
    clock.tell_until(lambda: any(
        in_nanoseconds(base.epoch) == back for base in cloth['inputs/time_base']), 'the base')
    clock.run(0.05, 0.01, 1.0)
    wait_for_steps(cloth, clock, 10)
    assert cloth['state'][-1].run_state == ClothState.RUNNING


def test_a_clock_that_goes_back_is_refused(start):
    """Work on a cloth would be lost because another program was restarted."""
    cloth, clock = start(time__jump_back='refuse')
    follow(cloth, clock)
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 20)
    ahead = clock.now
    clock.tell_until(lambda: any(
        state.run_state == ClothState.STOPPED for state in cloth['state']), 'the stop',
        7 * NANOSECONDS)
    found = clock.tell_until(lambda: [
        status for array in cloth['diagnostics'] for status in array.status
        if 'time.jump_back is refuse' in status.message], 'why')
    assert '/clock went back from' in found[0].message and '~/reset' in found[0].message
    # Resumed, it waits until the clock has come so far again.
    assert cloth.call(SetBool, 'pause', data=False).success
    clock.tell(ahead + 10 * DT)
    wait_for_steps(cloth, clock, 30)
    # After a reset it begins where the clock is.
    back = 7 * NANOSECONDS
    clock.tell_until(
        lambda: cloth['state'][-1].run_state == ClothState.STOPPED, 'another stop', back)
    cloth.clear()
    assert cloth.call(Trigger, 'reset').success
    clock.tell_until(lambda: any(
        in_nanoseconds(base.epoch) == back for base in cloth['inputs/time_base']), 'the base')


def test_a_pause_leaves_time_out(start):
    """After a pause the cloth would make up for it in a burst."""
    cloth, clock = start()
    follow(cloth, clock)
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 20)
    assert cloth.call(SetBool, 'pause', data=True).success
    clock.tell(clock.now + 5 * NANOSECONDS)
    # A still picture has the present time, so that tf2 finds it beside a robot that moves on.
    clock.tell_until(lambda: any(
        in_nanoseconds(cloud.header.stamp) == clock.now for cloud in cloth['points']), 'a picture')
    assert cloth.call(SetBool, 'pause', data=False).success
    resumed = clock.now
    clock.run(0.1, 0.01, 1.0)
    clock.tell_until(lambda: any(
        stats.steps == 40 and in_nanoseconds(stats.header.stamp) == resumed + 20 * DT
        for stats in cloth['stats']), '20 steps more')


def test_a_leap_is_left_out_and_said(start):
    """A clock that changes from 0 to that of the wall would have the cloth simulate 50 years."""
    cloth, clock = start()
    follow(cloth, clock)
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 20)
    clock.tell(clock.now + 10**18)
    clock.tell_until(lambda: any(
        stats.steps == 20 and in_nanoseconds(stats.header.stamp) == clock.now
        for stats in cloth['stats']), 'the cloth is there, as it was')


def test_without_a_clock_it_says_so(start):
    """A user would wait in vain, and not know for what."""
    cloth, clock = start(recording__enabled=True)
    answer = cloth.call(StartRecording, 'start_recording')
    assert not answer.success and 'no message has come on /clock' in answer.message
    found = cloth.client.spin_until(lambda: [
        status for array in cloth['diagnostics'] for status in array.status
        if 'time.source: ros waits for' in status.message], 'what is missing')
    assert 'start what publishes it' in found[0].message
    cloth.wait_for('stats')
    assert cloth['stats'][-1].steps == 0
    # The recording that was asked for begins as soon as there is a time.
    follow(cloth, clock)
    clock.tell_until(lambda: any(state.recording for state in cloth['state']), 'it records')
    assert cloth.call(Trigger, 'stop_recording').success


def test_a_second_clock_is_said(start, client):
    """Two clocks would reset the cloth again and again."""
    cloth, clock = start()
    follow(cloth, clock)
    with ClockTeller(client, BEGIN):
        found = clock.tell_until(lambda: [
            status for array in cloth['diagnostics'] for status in array.status
            if '/clock has 2 publishers' in status.message], 'a word of it')
        assert 'stop the others' in found[0].message
        clock.run(0.1, 0.01, 1.0)
        wait_for_steps(cloth, clock, 20)
        clock.tell_until(lambda: cloth['state'][-1].run_state == ClothState.STOPPED,
                         'the stop', BEGIN)
        assert not cloth['inputs/command'], 'and no reset'


def test_a_clock_that_has_gone_is_said(start):
    """A cloth whose simulator has ended would stand still, with all well."""
    cloth, clock = start()
    follow(cloth, clock)
    clock.__exit__()
    cloth.client.spin_until(lambda: any(
        '/clock has no publisher any more' in status.message for array in cloth['diagnostics']
        for status in array.status), 'a word of it')


def test_it_stays_with_the_clock(start):
    """Half of the stamps would be of another time from then on."""
    cloth, _ = start()
    refused = cloth.set_parameters(use_sim_time=False)
    assert not refused.successful and 'use_sim_time stays true' in refused.reason


def test_frames_are_found_at_both_times(start, client):
    """Inputs given in the frame of a robot's tool would be refused, or be somewhere else."""
    cloth, clock = start(colliders__names=['ball'], colliders__ball__size=[0.1],
                         colliders__ball__position=[0.0, 0.0, 0.2])
    follow(cloth, clock)
    assert cloth.call(
        Grasp, 'grasp', name='hand', pose=PoseMessage(position=Point(x=0.2, z=1.0))).success
    told = []
    tf = client.node.create_publisher(TFMessage, '/tf', 100)
    for number in range(1, 21):
        clock.tell(BEGIN + number * 2 * DT)
        moved = transform('tool0', 'world', Pose((0.01 * number, 0.0, 1.0)))
        moved.header.stamp = ros_time(clock.now)
        told.append(TFMessage(transforms=[moved]))
        tf.publish(told[-1])
        client.spin_for(0.02)
    wait_for_steps(cloth, clock, 40)
    # /tf has several messages a frame, and is read more slowly than the clouds.
    clock.tell_until(
        lambda: max(stamps_of(cloth)['tf'], default=0) == clock.now, 'the last frames')
    frames = ('tool0', PIN, 'followed_cloth_sim_grasp_hand')
    places = SeenFrames(told + cloth['tf'])
    past = BEGIN + 20 * DT
    for one in frames:
        for other in frames:
            places.pose(one, other, None)
            places.pose(one, other, past)
    at_past = places.pose('tool0', PIN, past)
    # The node finds the same at the same times.
    for time, place in ((past, 0.1), (0, 0.2)):
        header = Header(frame_id='tool0', stamp=ros_time(time) if time else Time())
        answer = cloth.client.spin_until(lambda: _moved(cloth, header), 'tool0 is known')
        assert f'moves to ({place:g}, 0, 1)' in answer.message
    pin = places.pose(PIN, 'world', past)
    assert at_past.position == pytest.approx(
        [a - b for a, b in zip((0.1, 0.0, 1.0), pin.position)])
    client.node.destroy_publisher(tf)


def test_frames_are_found_beside_a_robot_from_a_bag(start, client, tmp_path):
    """Beside a bag that is played, cloth and robot would be of different times."""
    cloth, clock = start(start_paused=True)
    # The player has the clock.
    clock.__exit__()
    assert cloth.call(
        Grasp, 'grasp', name='hand', pose=PoseMessage(position=Point(x=0.2, z=1.0))).success
    assert cloth.call(SetBool, 'pause', data=False).success
    moments, interval, messages = 400, 5_000_000, []
    for number in range(moments):
        moved = transform('tool0', 'world', Pose((0.001 * number, 0.0, 1.0)))
        moved.header.stamp = ros_time(BEGIN + number * interval)
        messages += [('/clock', Clock(clock=moved.header.stamp)),
                     ('/tf', TFMessage(transforms=[moved]))]
    bag = write_bag(tmp_path / 'robot', messages, begin=BEGIN, interval=interval // 2)
    tf = client.watch(TFMessage, '/tf')
    with PlayerProcess(tmp_path, bag, '--clock', '--paused', '--delay', 0) as player:
        player.resume(client)
        assert player.wait(client) == 0
    # The time between the first two messages may pass before the node runs.
    end = BEGIN + (moments - 1) * interval
    client.spin_until(lambda: any(
        0 <= end - in_nanoseconds(cloud.header.stamp) < 0.05 * NANOSECONDS
        for cloud in cloth['points']), 'the cloth at the end of the bag')
    client.spin_until_quiet()
    assert {in_nanoseconds(base.epoch) for base in cloth['inputs/time_base']} <= {
        0, *range(BEGIN, end, interval)}
    places = SeenFrames(tf.messages)
    # Amid what the node has made: on a slow machine it joins the clock late.
    first = min(stamp for stamp in (
        in_nanoseconds(cloud.header.stamp) for cloud in cloth['points']) if stamp >= BEGIN)
    number = ((first + end) // 2 - BEGIN) // interval
    past = BEGIN + number * interval
    for frame in (PIN, 'followed_cloth_sim_grasp_hand'):
        for time, place in ((None, None), (past, 0.001 * number)):
            seen = places.pose('tool0', frame, time)
            if place is not None:
                own = places.pose(frame, 'world', time)
                assert seen.position == pytest.approx(
                    [a - b for a, b in zip((place, 0.0, 1.0), own.position)])


def _moved(cloth, header):
    answer = cloth.call(MoveFrame, 'move_collider', name='ball', header=header,
                        pose=PoseMessage(), keep_orientation=True)
    return answer if answer.success else None


def test_a_recording_is_of_that_time_and_runs_again(start):
    """What was recorded beside a simulator would have another time, or not run again."""
    cloth, clock = start()
    follow(cloth, clock)
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 20)
    path = Path(cloth.call(StartRecording, 'start_recording', name='followed').path)
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 40)
    back = 3 * NANOSECONDS
    clock.tell_until(lambda: cloth['inputs/command'], 'the reset', back)
    clock.tell_until(
        lambda: in_nanoseconds(cloth['inputs/time_base'][-1].epoch) == back, 'its time')
    clock.run(0.1, 0.01, 1.0)
    wait_for_steps(cloth, clock, 20)
    assert cloth.call(SetBool, 'pause', data=True).success
    assert cloth.call(Step, 'step', steps=2).success
    assert cloth.call(Trigger, 'stop_recording').success
    times = [log_time for _, log_time, _ in Recorded(path).entries]
    assert times == sorted(times)
    assert BEGIN <= times[0] and times[-1] < BEGIN + NANOSECONDS
    clouds = Recorded(path).messages('points')
    assert in_nanoseconds(clouds[-1].header.stamp) < 4 * NANOSECONDS, 'as it was sent'
    arrays = Recording(path).arrays('stats')
    assert arrays['sim_time'][-1] == pytest.approx(0.11)
    assert arrays['time'][0] == pytest.approx(0.1)
    assert arrays['time'][-1] == pytest.approx(0.2 + 0.11)
    assert_same(path, node=NAME)
