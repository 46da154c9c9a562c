# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The services of simulation_interfaces, asked by another process."""

import json

from action_msgs.msg import GoalStatus
from ament_index_python.packages import get_package_share_path
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_ros.node.simulation_services import FEATURES
from cloth_under_test import ClothUnderTest
from cloth_under_test import HANDLED
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from node_process import NodeProcess
import numpy as np
import pytest
from rclpy.action import ActionClient
from simulation_interfaces.action import SimulateSteps
from simulation_interfaces.msg import Bounds
from simulation_interfaces.msg import EntityCategory
from simulation_interfaces.msg import EntityFilters
from simulation_interfaces.msg import Result
from simulation_interfaces.msg import SimulationState
from simulation_interfaces.msg import TagsFilter
from simulation_interfaces.srv import GetEntities
from simulation_interfaces.srv import GetEntitiesStates
from simulation_interfaces.srv import GetEntityState
from simulation_interfaces.srv import GetSimulationState
from simulation_interfaces.srv import GetSimulatorFeatures
from simulation_interfaces.srv import ResetSimulation
from simulation_interfaces.srv import SetSimulationState
from simulation_interfaces.srv import StepSimulation

STOPPED, PLAYING, PAUSED = (
    SimulationState.STATE_STOPPED, SimulationState.STATE_PLAYING, SimulationState.STATE_PAUSED)
ALREADY = SetSimulationState.Response.ALREADY_IN_TARGET_STATE
# Of simulation_interfaces 1.6.1, as its own build has them in share/.
HASHES = {
    'action/SimulateSteps':
        'RIHS01_f0837c898e1219cd73bf4c041feab41e8c533e8e1057e982744dba7b093467eb',
    'msg/Bounds':
        'RIHS01_e8624fe51f0f5548197542697d924c5699ac7198f1e4c68e50c3ca2af73f5b3f',
    'msg/EntityCategory':
        'RIHS01_43bdf7933fddf75f6970f7a8fe7078524355d821d390b3954bb46ac36c03dfe1',
    'msg/EntityFilters':
        'RIHS01_8e7b12e8ea062f14c55de4877221fe1b7cd9749665a7ad8a4ab855fc4b148303',
    'msg/EntityState':
        'RIHS01_2e0464a85eb80a939025075d6c20761eca6a4cb9d6baf2c0ba373467c8b598d0',
    'msg/Result':
        'RIHS01_cf43a306adff3337a0a47143d8f5689933bc70a30478f13b077dc1fe3bc5ad17',
    'msg/SimulationState':
        'RIHS01_bb9f87ccdd98fba113052a512d9801e84ce732d0a2b3c2b0cb281828de36e415',
    'msg/SimulatorFeatures':
        'RIHS01_8b101c8529bc0ea3dcf056078254768f39832b9ef0adaf93bd5cea96c0de3305',
    'msg/TagsFilter':
        'RIHS01_5c3efc51e8ed04c266c09cb4691ec95b964cd410558e01d8c83646b038826b45',
    'srv/GetEntities':
        'RIHS01_cb90004c48cd50f37732fb008e22c34c261dd680a723bf0f85d8437ea4498bf7',
    'srv/GetEntitiesStates':
        'RIHS01_0a76170d0c1c90e1eaf805cfab78ea801d1f82df309a28c1f0fae4b570f19754',
    'srv/GetEntityState':
        'RIHS01_749c91f2a2353d98367b64f2995a0f5842ce92a08ec1ffb3e185540a91557fb5',
    'srv/GetSimulationState':
        'RIHS01_3362dcebee4b1afebbf9c4beee5c79c1455385aded62092a892d61fde8644f30',
    'srv/GetSimulatorFeatures':
        'RIHS01_abb9439c8cf196722a469fb6c68b44b484f198c2a1356ac38849a29c2a20a794',
    'srv/ResetSimulation':
        'RIHS01_4ce285d7ff9b8ac70dcc95161f32bf54c05a6f4b13427990e41ab40c36c39646',
    'srv/SetSimulationState':
        'RIHS01_a868b916dce49974f637ba252141258c4b07b0c06858b88af560e3eb6bfbcb30',
    'srv/StepSimulation':
        'RIHS01_913fe0653690ce6bf8f09f316e6a626747012e9fca31e26719910d417aa8565c',
}


@pytest.fixture(scope='module')
def simulator(tmp_path_factory, client):
    """Start a node that serves them, paused."""
    values = {**HANDLED, 'start_paused': True, 'simulation_interfaces': True}
    with NodeProcess(tmp_path_factory.mktemp('simulator'), values, '-r', '__ns:=/simulator'):
        yield ClothUnderTest(client, values, '/simulator/cloth_sim')


def ask(cloth, kind, name, **fields):
    """Return the answer of a service in the namespace of the node."""
    return cloth.client.call(kind, f'/simulator/{name}', **fields)


def state_of(cloth):
    """Return the state of the simulation."""
    answer = ask(cloth, GetSimulationState, 'get_simulation_state')
    assert answer.result.result == Result.RESULT_OK
    return answer.state.state


def set_state(cloth, state):
    """Set the state of the simulation; return the result."""
    return ask(cloth, SetSimulationState, 'set_simulation_state',
               state=SimulationState(state=state)).result


def test_states_are_set_and_told(simulator):
    """A launch file for several simulators could not start, pause and stop this one."""
    set_state(simulator, PAUSED)
    assert set_state(simulator, STOPPED).result == Result.RESULT_OK
    assert state_of(simulator) == STOPPED
    assert set_state(simulator, STOPPED).result == ALREADY
    # From stopped to paused is allowed, and time does not pass.
    assert set_state(simulator, PAUSED).result == Result.RESULT_OK
    assert state_of(simulator) == PAUSED
    assert set_state(simulator, PLAYING).result == Result.RESULT_OK
    assert state_of(simulator) == PLAYING
    assert set_state(simulator, PLAYING).result == ALREADY
    simulator.wait_for('stats', lambda stats: stats.steps > 5)
    assert set_state(simulator, PAUSED).result == Result.RESULT_OK
    assert state_of(simulator) == PAUSED
    simulator.clear()
    assert set_state(simulator, STOPPED).result == Result.RESULT_OK
    assert state_of(simulator) == STOPPED
    simulator.wait_for('stats', lambda stats: stats.steps == 0)
    for state in (SimulationState.STATE_QUITTING, SimulationState.STATE_NO_WORLD, 99):
        refused = set_state(simulator, state)
        assert refused.result == Result.RESULT_FEATURE_UNSUPPORTED and refused.error_message


def test_steps_are_made_while_paused(simulator):
    """A program that steps a simulator would get none, or a running one out of step."""
    set_state(simulator, PAUSED)
    set_state(simulator, STOPPED)
    simulator.clear()
    assert ask(simulator, StepSimulation, 'step_simulation', steps=7).result.result == (
        Result.RESULT_OK)
    simulator.wait_for('stats', lambda stats: stats.steps == 7)
    assert state_of(simulator) == PAUSED
    client = ActionClient(simulator.client.node, SimulateSteps, '/simulator/simulate_steps')
    simulator.client.spin_until(client.server_is_ready, 'simulate_steps is served')
    simulator.client.spin_for(0.1)
    heard = []
    for steps, is_canceled in ((500, False), (100_000, True)):
        goal = client.send_goal_async(
            SimulateSteps.Goal(steps=steps), lambda message: heard.append(message.feedback))
        simulator.client.spin_until(goal.done, 'it is accepted')
        simulator.client.spin_until(lambda: heard, 'feedback')
        # Not before: with the result, rclpy drops the feedback that waits.
        end = goal.result().get_result_async()
        assert heard[-1].completed_steps + heard[-1].remaining_steps == steps
        if is_canceled:
            goal.result().cancel_goal_async()
        simulator.client.spin_until(end.done, 'the end')
        assert end.result().status == (
            GoalStatus.STATUS_CANCELED if is_canceled else GoalStatus.STATUS_SUCCEEDED)
        assert (end.result().result.result.result == Result.RESULT_OK) != is_canceled
        simulator.client.spin_until_quiet()
        heard.clear()
    client.destroy()
    set_state(simulator, PLAYING)
    refused = ask(simulator, StepSimulation, 'step_simulation', steps=1).result
    assert refused.result == Result.RESULT_OPERATION_FAILED
    assert 'pause it first' in refused.error_message
    set_state(simulator, PAUSED)


def test_a_reset_is_of_time_and_state(simulator):
    """What asks for a part of it would be told that it was done, and it was not."""
    set_state(simulator, PAUSED)
    for scope in (0, 255, 3, 7):
        ask(simulator, StepSimulation, 'step_simulation', steps=3)
        simulator.clear()
        assert ask(simulator, ResetSimulation, 'reset_simulation', scope=scope).result.result == (
            Result.RESULT_OK)
        simulator.wait_for('inputs/command')
    for scope in (1, 2, 4):
        assert ask(simulator, ResetSimulation, 'reset_simulation', scope=scope).result.result == (
            Result.RESULT_FEATURE_UNSUPPORTED)


def test_entities_are_the_cloth_and_what_touches_it(simulator):
    """A tool that lists what is in a simulator would find no cloth, or not where it is."""
    set_state(simulator, PAUSED)
    set_state(simulator, STOPPED)
    assert simulator.call(Grasp, 'grasp', name='hand', pose=Pose(
        position=Point(x=0.45, y=-0.35, z=1.0))).success
    found = ask(simulator, GetEntities, 'get_entities')
    assert found.result.result == Result.RESULT_OK
    assert found.entities == ['cloth', 'colliders/ball', 'colliders/floor', 'grasps/hand']
    assert ask(simulator, GetEntities, 'get_entities', filters=EntityFilters(
        filter='^colliders/(ball|box)$')).entities == ['colliders/ball']
    for filters, code in (
            (EntityFilters(filter='('), Result.RESULT_OPERATION_FAILED),
            (EntityFilters(categories=[EntityCategory()]), Result.RESULT_FEATURE_UNSUPPORTED),
            (EntityFilters(tags=TagsFilter(tags=['a'])), Result.RESULT_FEATURE_UNSUPPORTED),
            (EntityFilters(bounds=Bounds(type=Bounds.TYPE_BOX)),
             Result.RESULT_FEATURE_UNSUPPORTED)):
        refused = ask(simulator, GetEntities, 'get_entities', filters=filters)
        assert refused.result.result == code and refused.result.error_message
        assert not refused.entities
    assert simulator.call(
        MoveFrame, 'move_collider', name='ball', speed=0.2, keep_orientation=True,
        pose=Pose(position=Point(x=0.0, y=0.0, z=0.65))).success
    simulator.clear()
    assert ask(simulator, StepSimulation, 'step_simulation', steps=10).result.result == 1
    states = ask(simulator, GetEntitiesStates, 'get_entities_states')
    by_name = dict(zip(states.entities, states.states))
    ball = by_name['colliders/ball']
    assert ball.pose.position.z == pytest.approx(0.85 - 10 * HANDLED['dt'] * 0.2)
    assert ball.twist.linear.z == pytest.approx(-0.2)
    assert ball.header.frame_id == 'world' and simulator.steps_of(ball) == 10
    points = simulator.frame(10)
    cloth = ask(simulator, GetEntityState, 'get_entity_state', entity='cloth')
    assert cloth.result.result == Result.RESULT_OK
    assert cloth.state.pose.position.z == pytest.approx(np.mean(points['z'], dtype=float))
    assert cloth.state.twist.linear.z == pytest.approx(np.mean(points['vz'], dtype=float))
    missing = ask(simulator, GetEntityState, 'get_entity_state', entity='nobody')
    assert missing.result.result == Result.RESULT_NOT_FOUND
    assert 'give one of cloth' in missing.result.error_message


def test_the_features_are_those_that_are_there(simulator):
    """A program would ask for what it is told to be there, and fail."""
    told = ask(simulator, GetSimulatorFeatures, 'get_simulator_features').features
    assert list(told.features) == list(FEATURES)
    assert told.custom_info
    served = {
        name.rpartition('/')[2]
        for name, _ in simulator.client.node.get_service_names_and_types_by_node(
            'cloth_sim', '/simulator') if name.count('/') == 2}
    assert served == {
        'get_simulator_features', 'get_entities', 'get_entity_state', 'get_entities_states',
        'get_simulation_state', 'set_simulation_state', 'reset_simulation', 'step_simulation'}


@pytest.mark.parametrize('name', HASHES)
def test_types_are_those_of_the_package(name):
    """Middlewares that compare types would not connect a client of the real package."""
    described = json.loads((get_package_share_path('simulation_interfaces') / f'{name}.json')
                           .read_text(encoding='utf-8'))
    assert {f'simulation_interfaces/{name}': HASHES[name]}.items() <= {
        each['type_name']: each['hash_string'] for each in described['type_hashes']}.items()
