# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Modes are compiled while the cloth goes on; here without a shader cache, as on a new machine."""

from collections.abc import Iterator
from pathlib import Path
from signal import SIGINT
import time

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from rcl_interfaces.srv import GetParameters
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

# A mode still takes seconds where the driver does not optimise it.
NO_CACHE = {'MESA_SHADER_CACHE_DISABLE': 'true', 'GALLIVM_PERF': 'nopt'}
RUNNING = {**SCENE, 'publish.rate': 50.0}


@pytest.fixture
def cold(
        client: GraphClient, tmp_path: Path,
        request: pytest.FixtureRequest) -> Iterator[ClothUnderTest]:
    """Run a node whose modes have to be compiled."""
    namespace = f'/cold_{request.node.name[-20:]}'
    with NodeProcess(tmp_path, RUNNING, '-r', f'__ns:={namespace}', environment=NO_CACHE):
        cloth = ClothUnderTest(client, RUNNING, f'{namespace}/cloth_sim')
        cloth.wait_for('stats')
        yield cloth


def ask(cloth: ClothUnderTest, mode: str, *, wait: bool = True):
    """Ask for a mode and return the future of the answer."""
    service = cloth.client.service(SetMode, f'{cloth.name}/set_mode')
    return service.call_async(SetMode.Request(mode=mode, wait=wait))


def test_the_cloth_goes_on_and_services_answer_meanwhile(cold: ClothUnderTest):
    """On a new machine the node would be blind for as long as the compiler takes."""
    cold.clear()
    # A client with a short timeout has its answer at once, another waits for the mode.
    answer = ask(cold, 'constraint', wait=False)
    cold.client.spin_until(answer.done, 'set_mode answers')
    assert answer.result().success and '~/state' in answer.result().message
    answer = ask(cold, 'constraint')
    cold.wait_for('state', lambda state: state.preparing == 'constraint')
    first = cold.wait_for('stats').steps
    for kind, name, fields in (
            (GetParameters, 'get_parameters', {'names': ['dt']}),
            (ApplyPush, 'apply_push', {'force': Vector3(z=0.01), 'duration': 0.01}),
            (SetPin, 'set_pin', {'row': 4, 'col': 4}),
            (SetPin, 'set_pin', {'row': 4, 'col': 4, 'release': True})):
        cold.call(kind, name, **fields)
    cold.wait_for('stats', lambda stats: stats.steps > first + 20)
    cold.wait_for('state', lambda state: state.preparing and state.compiled > 3)
    cold.client.spin_until(answer.done, 'the mode takes over')
    assert answer.result().success and answer.result().previous_mode == 'mass_spring'
    state = cold.wait_for('state', lambda state: state.mode == 'constraint')
    assert state.preparing == '' and state.substeps > 0
    change = cold.wait_for('inputs/mode', lambda change: change.mode == 'constraint')
    # By simulated time, all of that came before the mode did.
    took_over = cold.steps_of(change)
    assert took_over > first + 20
    for topic in ('inputs/push', 'inputs/pin'):
        assert all(cold.steps_of(message) < took_over for message in cold[topic])
    # Setting the current mode is answered at the end of the current step.
    assert cold.call(SetMode, 'set_mode', mode='constraint', wait=True).message.startswith(
        'mode constraint, was')


def test_the_mode_asked_for_last_wins(client: GraphClient, tmp_path: Path):
    """A mode that nobody wants any more would take over seconds later."""
    # The paper's scheme has few programs: it is ready before the other mode would be.
    values = {**RUNNING, 'adaptive.scheme': 'paper'}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/last', environment=NO_CACHE):
        cloth = ClothUnderTest(client, values, '/last/cloth_sim')
        cloth.wait_for('stats')
        first = ask(cloth, 'constraint')
        cloth.wait_for('state', lambda state: state.preparing == 'constraint')
        second = ask(cloth, 'adaptive')
        client.spin_until(first.done, 'the first answer')
        assert not first.result().success
        assert 'mode adaptive was requested before' in first.result().message
        client.spin_until(second.done, 'the second answer')
        assert second.result().success
        cloth.clear()
        third = ask(cloth, 'constraint')
        cloth.wait_for('state', lambda state: state.preparing == 'constraint')
        assert cloth.set_parameters(mode='adaptive').successful
        client.spin_until(third.done, 'the third answer')
        assert not third.result().success
        cloth.clear()
        cloth.wait_for('stats', lambda stats: stats.steps > 0)
        assert cloth.call(SetMode, 'set_mode', mode='adaptive').previous_mode == 'adaptive'


def test_a_new_node_answers_before_its_first_mode_is_ready(client: GraphClient, tmp_path: Path):
    """A node in mode constraint would not respond for seconds, or lose requests."""
    values = {**SCENE, 'mode': 'constraint', 'start_paused': True}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/early', environment=NO_CACHE):
        cloth = ClothUnderTest(client, values, '/early/cloth_sim')
        assert cloth['state'][-1].preparing == 'constraint'
        assert cloth['state'][-1].substeps == 0
        assert cloth.call(SetPin, 'set_pin', row=5, col=5).success
        push = cloth.call(ApplyPush, 'apply_push', force=Vector3(z=0.1), duration=0.1)
        assert push.success and push.nodes == 8 * 10 - 3
        assert cloth.call(Trigger, 'reset').success
        assert cloth.call(Step, 'step', steps=3).sim_time == pytest.approx(3 * cloth.dt)
        frame = cloth.frame(3)
        assert frame['flags'][0, 0] & 1 and not frame['flags'][5, 5] & 1


@pytest.mark.parametrize('mode', [
    pytest.param(mode, marks=() if mode == 'constraint' else pytest.mark.long) for mode in MODES])
def test_an_interrupt_while_compiling_closes_the_recording(
        client: GraphClient, tmp_path: Path, mode: str):
    """Ctrl-C or a launch file would end in SIGKILL, with the recording open."""
    values = {**SCENE, 'mode': mode, 'recording.enabled': True, 'recording.name': 'cut'}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/cut', environment=NO_CACHE) as node:
        client.spin_until(
            lambda: 'recording to' in node.output or not node.running, 'the recording')
        time.sleep(0.3)
        node.send(SIGINT)
        assert node.wait() == 0, node.output
    assert (tmp_path / 'bags' / 'cut' / 'metadata.yaml').is_file()
    assert BagReader(tmp_path / 'bags' / 'cut').topics


def test_a_long_run_of_steps_leaves_the_node_free(cloth: ClothUnderTest):
    """~/step with many steps would make the node mute for as long."""
    service = cloth.client.service(Step, f'{cloth.name}/step')
    answer = service.call_async(Step.Request(steps=100_000))
    assert cloth.call(GetParameters, 'get_parameters', names=['dt']).values
    refused = cloth.call(Step, 'step', steps=1)
    assert not refused.success and 'another caller' in refused.message
    assert not answer.done()
    assert cloth.call(Trigger, 'reset').success
    cloth.client.spin_until(answer.done, 'the steps end')
    assert not answer.result().success and 'the cloth was reset' in answer.result().message
    assert cloth.call(Step, 'step', steps=2).sim_time == pytest.approx(2 * cloth.dt)
    assert cloth.call(SetBool, 'pause', data=False).success


def mode_parameter(cloth):
    """Return the value of the parameter mode."""
    return cloth.call(GetParameters, 'get_parameters', names=['mode']).values[0].string_value


def test_returns_the_previous_mode(cloth):
    """A caller could not go back to the mode it found."""
    response = cloth.call(SetMode, 'set_mode', mode='mass_spring')
    assert (response.success, response.previous_mode) == (True, 'mass_spring')


@pytest.mark.parametrize('mode, reason', [
    ('fluid', 'must be one of mass_spring, constraint, adaptive'), ('', 'must be one of')])
def test_refuses_an_unknown_mode(cloth, mode, reason):
    """A mistyped mode would be taken, or end the node."""
    response = cloth.call(SetMode, 'set_mode', mode=mode)
    assert (response.success, response.previous_mode) == (False, 'mass_spring')
    assert reason in response.message
    assert mode_parameter(cloth) == 'mass_spring'
    assert not cloth['inputs/mode']


@pytest.mark.parametrize('mode', MODES)
def test_takes_the_modes_that_the_state_names(cloth, mode):
    """A tool would offer modes that are refused, or the parameter would differ from the mode."""
    before = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert mode in before.available_modes
    response = cloth.call(SetMode, 'set_mode', mode=mode)
    assert (response.success, response.previous_mode) == (True, before.mode)
    after = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert after.mode == mode_parameter(cloth) == mode


@pytest.mark.parametrize('mode', MODES)
def test_the_parameter_does_what_the_service_does(cloth, mode):
    """`ros2 param set` would change the parameter and not the simulation."""
    before = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    cloth.clear()
    result = cloth.set_parameters(mode=mode)
    assert result.successful
    assert mode in before.available_modes
    assert mode_parameter(cloth) == mode
    cloth.wait_for('state', lambda state: state.mode == mode and not state.preparing)
