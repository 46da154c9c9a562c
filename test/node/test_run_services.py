# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""~/pause, ~/step, ~/reset, ~/start_recording, ~/stop_recording, and what follows: ~/state."""

from pathlib import Path

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.messages.stamp import nanoseconds
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import numpy as np
import pytest
from recorded import Recorded
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger


def start(cloth, name=''):
    """Start a recording."""
    return cloth.call(StartRecording, 'start_recording', name=name)


def record(cloth, *actions):
    """Return what is recorded while the actions are done."""
    response = start(cloth)
    assert response.success
    for action in actions:
        assert action().success
    assert cloth.call(Trigger, 'stop_recording').success
    return Recorded(Path(response.path))


def test_a_node_runs_without_what_writes_recordings(client, tmp_path):
    """A machine where rosdep could not install mcap could not run the node at all."""
    start_without = (
        'import sys; sys.modules["mcap"] = sys.modules["rosbags"] = None; '
        'from cloth_sim_ros.node.main import main; sys.exit(main())')
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/no_mcap', start=start_without):
        cloth = ClothUnderTest(client, PAUSED, '/no_mcap/cloth_sim')
        answer = start(cloth)
        assert not answer.success
        assert 'pip install mcap rosbags' in answer.message
        assert cloth.call(Step, 'step', steps=4).success


def test_records_the_published_bytes(cloth):
    """A recording would show another run than the topics did."""
    bag = record(
        cloth, *[lambda: cloth.call(Step, 'step', steps=4)] * 3)
    recorded = bag.messages('points')
    cloth.client.spin_until(
        lambda: cloth['points'] and cloth.steps_of(cloth['points'][-1]) == 12, 'all frames arrive')
    # A paused node publishes its frame again each second, for whoever comes late.
    published = {cloth.points_of(cloud).tobytes(): None for cloud in cloth['points']}
    assert len(recorded) == 4, 'the frame of the start, and one for each step'
    assert [np.frombuffer(cloud.data, POINT_DTYPE).tobytes() for cloud in recorded] == [*published]
    assert [stats.steps for stats in bag.messages('stats')] == [0, 4, 8, 12]


def test_begins_with_all_that_holds(cloth):
    """A recording started late could not be run again: pins, pushes or the mode would lack."""
    cloth.call(SetPin, 'set_pin', row=3, col=4)
    cloth.call(SetPin, 'set_pin', row=0, col=9, release=True)
    cloth.call(MovePin, 'move_pin', row=3, col=4, target=Point(z=3.0), speed=0.5)
    cloth.call(ApplyPush, 'apply_push', force=Vector3(z=1.0), duration=0.5)
    cloth.call(Step, 'step', steps=10)
    bag = record(cloth)
    parameters, = bag.messages('inputs/parameters')
    assert [entry.name for entry in parameters.new_parameters] == [f.name for f in FIELDS]
    assert [mode.mode for mode in bag.messages('inputs/mode')] == ['mass_spring']
    pins = bag.messages('inputs/pin')
    assert {(pin.row, pin.col, pin.pinned) for pin in pins} == {(3, 4, True), (0, 9, False)}
    move, = bag.messages('inputs/pin_target')
    assert (move.row, move.col, move.target.z, move.speed) == (3, 4, 3.0, 0.5)
    push, = bag.messages('inputs/push')
    assert (push.force.z, push.start, push.duration) == (1.0, 0.0, 0.5)
    mesh, = bag.messages('topology')
    assert len(mesh.triangles) == 2 * 7 * 9
    state = bag.messages('state')[0]
    assert (state.recording, state.run_state) == (True, 'paused')
    cloud, = bag.messages('points')
    assert cloth.steps_of(cloud) == 10


def test_records_inputs_as_they_come(cloth):
    """A recording could not be run again: what was done in it would lack."""
    bag = record(
        cloth,
        lambda: cloth.call(Step, 'step', steps=2),
        lambda: cloth.call(ApplyPush, 'apply_push', force=Vector3(x=1.0), duration=0.1),
        lambda: cloth.call(SetPin, 'set_pin', row=6, col=6),
        lambda: cloth.call(MovePin, 'move_pin', row=6, col=6, target=Point(z=2.0)),
        lambda: cloth.call(Trigger, 'clear_pushes'))
    for topic in ('push', 'pin', 'pin_target', 'command'):
        message = bag.messages(f'inputs/{topic}')[-1]
        assert cloth.steps_of(message) == 2, topic


def test_log_time_grows_through_a_reset(cloth):
    """A player would mix what came before a reset with what came after it."""
    bag = record(
        cloth,
        lambda: cloth.call(Step, 'step', steps=10),
        lambda: cloth.call(Trigger, 'reset'),
        lambda: cloth.call(Step, 'step', steps=10))
    times = [time for _, time, _ in bag.entries]
    assert times == sorted(times)
    assert times[-1] - times[0] == 100_000_000
    clouds = bag.messages('points')
    assert [cloth.steps_of(cloud) for cloud in clouds] == [0, 10, 0, 10]


def test_a_pause_is_not_recorded_again_and_again(cloth):
    """A recording of a paused cloth would grow with copies of one moment."""
    path = Path(start(cloth).path)
    cloth.frame(0)
    cloth.clear()
    cloth.frame(0)
    cloth.wait_for('diagnostics')
    assert cloth.call(Trigger, 'stop_recording').success
    assert len(Recorded(path).messages('points')) == 1


def test_state_tells_of_the_recording(cloth):
    """A tool would not know whether a recording is being written, or where."""
    path = start(cloth, 'told').path
    state = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert (state.recording, state.recording_path) == (True, path)
    cloth.clear()
    cloth.call(Trigger, 'stop_recording')
    # It is published after the answer.
    cloth.wait_for('state', lambda state: not state.recording)
    state = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert (state.recording, state.recording_path) == (False, '')


def test_goes_inside_the_directory(cloth, shared_node):
    """A recording would be written somewhere else than configured."""
    assert Path(start(cloth, 'mine').path) == shared_node.folder / 'bags' / 'mine'


@pytest.mark.parametrize('name', ['../out', '/tmp/out', 'a/b', '..', '.', 'x' * 300, 'a\nb'])
def test_refuses_names_that_leave_the_directory(cloth, shared_node, name):
    """Anybody in the graph could write anywhere."""
    response = start(cloth, name)
    assert (response.success, response.path) == (False, '')
    assert 'plain name of a folder' in response.message
    assert not (shared_node.folder / 'out').exists()
    assert not cloth.client.read_kept(ClothState, f'{cloth.name}/state').recording


def test_refuses_to_overwrite(cloth):
    """An earlier recording would be lost."""
    assert start(cloth, 'once').success
    cloth.call(Trigger, 'stop_recording')
    response = start(cloth, 'once')
    assert not response.success
    assert 'already exists' in response.message


def test_refuses_a_second_recording(cloth):
    """The first recording would end without a word."""
    path = start(cloth).path
    response = start(cloth)
    assert not response.success
    assert path in response.message
    assert 'stop it first, with ~/stop_recording or `cloth_sim' in response.message


def test_refuses_to_stop_nothing(cloth):
    """A script would believe that it has recorded something."""
    response = cloth.call(Trigger, 'stop_recording')
    assert not response.success
    assert 'start one first, with ~/start_recording or `cloth_sim' in response.message


def test_an_unwritable_directory_is_no_end(cloth, shared_node):
    """A full or missing disk would end the simulation."""
    bags = shared_node.folder / 'bags'
    aside = shared_node.folder / 'bags_aside'
    bags.mkdir(exist_ok=True)
    bags.rename(aside)
    bags.write_text('a file, not a folder')
    try:
        response = start(cloth)
    finally:
        bags.unlink()
        aside.rename(bags)
    assert not response.success
    assert 'set recording.directory' in response.message
    assert start(cloth).success


def test_step_makes_the_steps_before_it_answers(cloth):
    """A caller of ~/step would read a state that is not there yet."""
    response = cloth.call(Step, 'step', steps=12)
    assert response.success
    assert response.sim_time == pytest.approx(12 * cloth.dt)
    # A paused node also shows once a second what is there already.
    cloth.wait_for('stats', lambda stats: stats.steps == 12)


def test_step_is_refused_while_running(cloth):
    """A step in a running simulation would mean nothing."""
    cloth.call(SetBool, 'pause', data=False)
    response = cloth.call(Step, 'step', steps=1)
    assert not response.success
    assert 'pause it first, with ~/pause with data: true or' in response.message


@pytest.mark.parametrize('steps', [0, 100001, 2**32 - 1])
def test_step_needs_a_sensible_number(cloth, steps):
    """A mistyped number would do nothing, or keep the node busy for days."""
    response = cloth.call(Step, 'step', steps=steps)
    assert not response.success
    assert f'steps {steps} is outside' in response.message
    assert '1 to 100000' in response.message
    assert cloth.call(Step, 'step', steps=1).sim_time == pytest.approx(cloth.dt)


def test_pause_holds_time_and_resume_lets_it_go(cloth):
    """A paused cloth would move on, or a resumed one would not."""
    assert cloth.call(SetBool, 'pause', data=False).message.startswith('running')
    assert cloth.wait_for('state').run_state == 'running'
    cloth.wait_for('stats', lambda message: message.steps >= 8)
    assert cloth.call(SetBool, 'pause', data=True).message.startswith('paused')
    held = cloth.call(Step, 'step', steps=1).sim_time
    assert cloth.call(Step, 'step', steps=1).sim_time == pytest.approx(held + cloth.dt)
    assert cloth['state'][-1].run_state == 'paused'
    cloth.clear()
    cloth.wait_for('stats', lambda stats: stats.real_time_factor == 0.0)


def test_pausing_twice_is_no_mistake(cloth):
    """A script that pauses to be sure would fail."""
    assert cloth.call(SetBool, 'pause', data=True).success
    assert cloth.call(SetBool, 'pause', data=True).success


def test_reset_goes_back_to_the_start(cloth, simulation):
    """Time, pose or pins would be left over from before the reset."""
    cloth.call(SetPin, 'set_pin', row=4, col=4)
    cloth.call(SetPin, 'set_pin', row=0, col=0, release=True)
    cloth.call(Step, 'step', steps=30)
    cloth.frame(30)
    cloth.clear()
    assert cloth.call(Trigger, 'reset').success
    assert cloth.frame(0).tobytes() == simulation.snapshot().records.tobytes()
    assert cloth.wait_for('inputs/command').command == 'reset'
    cloth.call(Step, 'step', steps=10)
    simulation.step(10)
    assert cloth.frame(10).tobytes() == simulation.snapshot().records.tobytes()


# What the node says it is doing.


def stamp_of(message):
    """Return the stamp of the header [ns]."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


def test_state_is_kept_for_those_who_come_late(cloth, simulation):
    """A tool that starts after the node would not learn its grid, device or run state."""
    state = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert (state.mode, state.run_state) == ('mass_spring', 'paused')
    assert (state.rows, state.cols, state.dt) == (8, 10, 0.005)
    assert state.substeps == simulation.substeps
    assert state.stability_limit == pytest.approx(simulation.stability_limit, rel=1e-12)
    assert state.device == simulation.device
    assert list(state.available_modes) == list(simulation.available_modes)
    assert (state.recording, state.recording_path) == (False, '')


def test_diagnostics_tell_device_and_pace(cloth, simulation):
    """A monitor of /diagnostics would not see the node."""
    told = cloth.wait_for('diagnostics', lambda message: any(
        status.message == 'paused' for status in message.status))
    assert all(status.name.startswith('cloth_sim: ') for status in told.status)
    assert any(simulation.device in status.message for status in told.status)


def test_diagnostics_carry_the_time_of_the_node(cloth):
    """The health of a run could not be put beside what the run did at that time."""
    path = Path(cloth.call(StartRecording, 'start_recording', name='').path)
    assert cloth.call(Step, 'step', steps=4).success
    # The topic is everybody's: another node may be there, and knows nothing of this recording.
    cloth.wait_for('diagnostics', lambda message: (
        stamp_of(message) == nanoseconds(4 * cloth.dt) and str(path) in str(message.status)))
    assert cloth.call(Trigger, 'stop_recording').success
    recorded = [
        (log_time, message) for topic, log_time, message in Recorded(path).entries
        if topic == '/diagnostics']
    assert recorded and all(stamp_of(message) == log_time for log_time, message in recorded)
    assert {log_time for log_time, _ in recorded} <= {0, nanoseconds(4 * cloth.dt)}
