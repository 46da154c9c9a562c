# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Long frames, and a run whose next state would not be finite."""

from signal import SIGINT

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import numpy as np
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

FRAME = 4  # steps of dt
TOO_MUCH = {'force': Vector3(x=1e30), 'duration': 1.0}


def test_stops_before_the_state_is_not_finite_and_can_go_on(client, tmp_path):
    """A cloth of NaN would be published for ever, or the node could not be used any more."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/blow_up') as node:
        cloth = ClothUnderTest(client, SCENE, '/blow_up/cloth_sim')
        cloth.wait_for('stats', lambda stats: stats.steps > 0)
        started = cloth.call(StartRecording, 'start_recording', name='blow_up')
        assert cloth.call(ApplyPush, 'apply_push', **TOO_MUCH).success
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        found = cloth.wait_for('diagnostics', lambda array: any(
            'non-finite' in status.message for status in array.status))
        [status] = [status for status in found.status if 'non-finite' in status.message]
        assert status.level == status.ERROR
        assert 'push with less force' in status.message
        assert node.output.count('the state became non-finite') == 1
        assert 'call ~/reset' in node.output

        answer = cloth.call(Step, 'step', steps=1)
        assert not answer.success and 'push with less force' in answer.message
        assert cloth.call(SetPin, 'set_pin', row=1, col=1).success, 'services still answer'
        cloth.clear()
        assert cloth.call(SetBool, 'pause', data=False).success, 'it tries again'
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')

        assert cloth.call(Trigger, 'clear_pushes').success
        stopped_at = cloth.wait_for('stats').steps
        cloth.clear()
        assert cloth.call(SetBool, 'pause', data=False).success
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        cloth.wait_for('stats', lambda stats: stats.steps > stopped_at + 20)
        assert cloth['state'][-1].run_state == 'running'
        assert all(np.abs(cloth.points_of(cloud)['x']).max() < 1e3 for cloud in cloth['points'])

        assert cloth.call(ApplyPush, 'apply_push', **TOO_MUCH).success
        cloth.client.spin_until(
            lambda: cloth['state'][-1].run_state == 'stopped', 'the second stop')
        cloth.clear()
        assert cloth.call(Trigger, 'reset').success
        cloth.wait_for('state', lambda state: state.run_state == 'running')
        assert cloth.call(Trigger, 'stop_recording').success
    frames = list(read_frames(Recording(started.path, '/blow_up/cloth_sim')))
    assert len(frames) > 2
    assert all(np.isfinite(frame.positions).all() for frame in frames)


def test_a_step_into_the_same_is_told_too(cloth):
    """A paused cloth would be stepped on as NaN, or forget that it was paused."""
    cloth.call(ApplyPush, 'apply_push', **TOO_MUCH)
    answer = cloth.call(Step, 'step', steps=50)
    assert not answer.success and 'non-finite' in answer.message
    assert answer.sim_time < 50 * cloth.dt
    cloth.wait_for('state', lambda state: state.run_state == 'stopped')
    cloth.clear()
    assert cloth.call(Trigger, 'clear_pushes').success
    assert cloth.call(Step, 'step', steps=1).success, 'without the push it can go on'
    cloth.wait_for('state', lambda state: state.run_state == 'paused')
    cloth.call(ApplyPush, 'apply_push', **TOO_MUCH)
    cloth.call(Step, 'step', steps=50)
    cloth.clear()
    cloth.call(Trigger, 'reset')
    cloth.wait_for('state', lambda state: state.run_state == 'paused')
    assert cloth.call(Step, 'step', steps=1).success


def test_services_are_answered_during_a_long_frame(client, tmp_path):
    """A low rate of frames would make the node deaf, to requests and to being stopped."""
    slow = {**SCENE, 'publish.rate': 0.001, 'dt': 1e-4}
    with NodeProcess(tmp_path, slow, '-r', '__ns:=/long_frame') as node:
        cloth = ClothUnderTest(client, slow, '/long_frame/cloth_sim')
        assert cloth.call(SetBool, 'pause', data=True).success
        assert 0.0 < cloth.call(Step, 'step', steps=1).sim_time < 1000.0
        assert cloth.call(SetBool, 'pause', data=False).success
        node.send(SIGINT)
        assert node.wait() == 0


def test_a_quick_cloth_runs_on(client, tmp_path):
    """A node whose frames are made in no time would end after 1024 of them."""
    quick = {**SCENE, 'rows': 2, 'cols': 2, 'real_time_factor': 0.0}
    with NodeProcess(tmp_path, quick, '-r', '__ns:=/quick') as node:
        stats = client.watch(ClothStats, '/quick/cloth_sim/stats', depth=10)
        client.spin_until(
            lambda: not node.running or (
                stats.messages and stats.messages[-1].steps > 1100 * FRAME), 'the 1100th frame')
        assert node.running, node.output


def test_a_run_stops_where_stamps_end(client, tmp_path):
    """The node would fail at each frame from then on, or leave a step without its answer."""
    start = (
        'import sys; import cloth_sim_ros.sim.stepping as stepping; stepping.LATEST = 0.1; '
        'from cloth_sim_ros.node.main import main; sys.exit(main())')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/late', start=start) as node:
        cloth = ClothUnderTest(client, SCENE, '/late/cloth_sim')
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        assert 'simulated time ends at 0.1 s' in node.output
        cloth.wait_for('stats', lambda stats: cloth.steps_of(stats) == 20)
        assert all(cloth.steps_of(stats) <= 20 for stats in cloth['stats'])
        for _ in range(2):
            answer = cloth.call(Step, 'step', steps=1)
            assert not answer.success and 'reset it' in answer.message
        assert cloth.call(Trigger, 'reset').success
        assert cloth.call(SetBool, 'pause', data=True).success
        assert cloth.call(Step, 'step', steps=1).message.startswith('1 steps done')
