# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Requests that come while a step is under way: answered at once, done at its end, recorded so."""

from pathlib import Path
import re
from signal import SIGINT
from signal import Signals
from signal import SIGTERM

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.analysis.recording import Recording
from cloth_under_test import ClothUnderTest
from command import cloth_sim
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

# A step takes many slices of the node's work.
SLOW = {'rows': 40, 'cols': 40, 'dt': 0.02, 'publish.rate': 50.0, 'recording.enabled': True,
        'recording.name': 'slow', 'publish.markers': False}

# Steps that take far longer than it takes to pause.
MANY = 100000


@pytest.mark.parametrize('mode', [
    'constraint', pytest.param('adaptive', marks=pytest.mark.long)])
def test_requests_within_steps_replay_to_the_bit(
        client: GraphClient, tmp_path: Path, mode: str):
    """A change would be applied within a step, or be recorded with the time of another step."""
    values = {**SLOW, 'mode': mode}
    with NodeProcess(tmp_path, values, '-r', f'__ns:=/slow_{mode}'):
        cloth = ClothUnderTest(client, values, f'/slow_{mode}/cloth_sim')
        cloth.wait_for('stats', lambda stats: stats.steps >= 3)
        for number in range(2):
            push = cloth.call(
                ApplyPush, 'apply_push', force=Vector3(y=0.2, z=0.1), duration=0.05,
                region='sphere', center=Point(z=0.9), radius=0.6)
            assert push.success and push.nodes > 0
            assert cloth.call(SetPin, 'set_pin', row=20, col=10 + number).success
            moved = cloth.call(
                MovePin, 'move_pin', row=0, col=0, speed=0.2,
                target=Point(x=-0.5, y=0.5, z=1.0 + 0.01 * number))
            assert moved.success
            assert cloth.call(SetPin, 'set_pin', row=20, col=10 + number, release=True).success
        assert cloth.call(Trigger, 'clear_pushes').success
        assert cloth.call(SetBool, 'pause', data=True).success
        assert cloth.call(SetBool, 'pause', data=False).success
        assert cloth.call(SetMode, 'set_mode', mode='mass_spring').success
        assert cloth.call(Trigger, 'reset').success
        cloth.clear()
        cloth.wait_for('stats', lambda stats: stats.steps >= 2)
        assert cloth.call(Trigger, 'stop_recording').success
    frames = len(list(Recording(tmp_path / 'bags' / 'slow').entries('points')))
    done = cloth_sim('resimulate', str(tmp_path / 'bags' / 'slow'))
    assert f'{frames} of {frames} frames bitwise identical' in done.stdout, (
        done.stdout + done.stderr)


def test_the_health_is_published_while_a_step_is_under_way(client: GraphClient, tmp_path: Path):
    """A supervisor would take a node with a slow cloth for dead."""
    values = {**SLOW, 'rows': 64, 'cols': 64, 'mode': 'constraint', 'recording.enabled': False}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/healthy'):
        cloth = ClothUnderTest(client, values, '/healthy/cloth_sim')
        cloth.wait_for('stats')
        cloth.clear()
        cloth.wait_for('diagnostics')
        paused = cloth.call(SetBool, 'pause', data=True)
        assert paused.message.startswith('paused at')
        # What the answer says is when the step under way has ended.
        time = float(paused.message.split()[-2])
        frame = cloth.wait_for(
            'stats', lambda stats: stats.sim_time == pytest.approx(time, abs=1e-4))
        assert frame.steps == pytest.approx(time / 0.02)


@pytest.mark.parametrize('values', [
    {'rows': 8, 'cols': 10, 'dt': 0.005}, {**SLOW, 'mode': 'constraint', 'rows': 64, 'cols': 64}],
    ids=['quick steps', 'slow steps'])
def test_pause_ends_steps_that_were_asked_for(
        client: GraphClient, tmp_path: Path, values: dict):
    """Time would run on for minutes after an answer that says it stands."""
    values = {**values, 'start_paused': True, 'recording.enabled': False}
    name = f'/cut_{values["rows"]}/cloth_sim'
    with NodeProcess(tmp_path, values, '-r', f'__ns:=/cut_{values["rows"]}'):
        cloth = ClothUnderTest(client, values, name)
        steps = client.service(Step, f'{name}/step').call_async(Step.Request(steps=MANY))
        paused = cloth.call(SetBool, 'pause', data=True)
        # A pause that is served before the steps have begun ends nothing.
        while 'steps' not in paused.message:
            assert not steps.done()
            paused = cloth.call(SetBool, 'pause', data=True)
        client.spin_until(steps.done, 'the answer to the steps')
        told = re.fullmatch(
            rf'paused at (.*) s; ~/step ends there, after (\d+) of {MANY} steps', paused.message)
        assert told, paused.message
        made = int(told[2])
        assert float(told[1]) == pytest.approx(made * cloth.dt, rel=1e-5)
        answer = steps.result()
        assert not answer.success and answer.sim_time == pytest.approx(made * cloth.dt)
        assert answer.message == (
            f'~/pause ended the steps at {told[1]} s, after {made} of {MANY}: request the other '
            f'{MANY - made} with ~/step')
        # Time stands where both say: the next step is the one after it.
        after = cloth.call(Step, 'step', steps=1)
        assert after.success and after.sim_time == pytest.approx((made + 1) * cloth.dt)
        cloth.wait_for('stats', lambda stats: stats.steps == made + 1)


@pytest.mark.parametrize('number', [SIGINT, pytest.param(SIGTERM, marks=pytest.mark.long)])
def test_a_signal_within_a_step_ends_the_node_in_order(
        client: GraphClient, tmp_path: Path, number: Signals):
    """The step would be undone on a device that is gone, or the recording be cut off."""
    values = {**SLOW, 'rows': 64, 'cols': 64, 'mode': 'constraint'}
    with NodeProcess(tmp_path, values, '-r', f'__ns:=/ended_{number.name}') as node:
        cloth = ClothUnderTest(client, values, f'/ended_{number.name}/cloth_sim')
        cloth.wait_for('stats', lambda stats: stats.steps >= 2)
        node.send(number)
        assert node.wait() == 0, node.output
        assert 'Error' not in node.output and 'Exception' not in node.output, node.output
    frames = list(Recording(tmp_path / 'bags' / 'slow').entries('points'))
    assert len(frames) >= 2
