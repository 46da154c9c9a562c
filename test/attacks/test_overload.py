# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""More requests at once than a node can answer at once."""

from collections.abc import Callable
import random
from typing import Any

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.node.guarded_node import SERVICE_QUALITY
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import numpy as np
from processor_time import processor_time
import pytest
from rcl_interfaces.srv import GetParameters
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

AT_ONCE = [200, pytest.param(500, marks=pytest.mark.long)]
# What is asked for, and whether all of it can be done.
REQUESTS: dict[str, tuple[type, str, Callable[[int], dict[str, Any]], bool]] = {
    'pushes': (ApplyPush, 'apply_push', lambda number: {
        'force': Vector3(z=1e-3), 'duration': 0.01 + 1e-6 * number}, True),
    'pins': (SetPin, 'set_pin', lambda number: {
        'row': number % 8, 'col': number % 10, 'release': number % 3 == 0}, True),
    'parameters': (GetParameters, 'get_parameters', lambda number: {'names': ['mode']}, True),
    'resets': (Trigger, 'reset', lambda number: {}, True),
    'steps': (Step, 'step', lambda number: {'steps': 1}, False),
}


@pytest.fixture(scope='module')
def cloth(client, tmp_path_factory):
    """Run a node for all kinds of requests."""
    with NodeProcess(tmp_path_factory.mktemp('overload'), SCENE, '-r', '__ns:=/overload') as node:
        yield ClothUnderTest(client, SCENE, '/overload/cloth_sim')
        assert node.running


@pytest.mark.parametrize('at_once', AT_ONCE)
@pytest.mark.parametrize('what', REQUESTS)
def test_each_of_many_requests_is_answered(cloth, what, at_once):
    """Beyond some ten requests in flight, answers would be lost without a word."""
    kind, name, fields, is_each_done = REQUESTS[what]
    cloth.call(Trigger, 'clear_pushes')
    cloth.call(SetBool, 'pause', data=what == 'steps')
    node = cloth.client.node
    service = node.create_client(kind, f'{cloth.name}/{name}', qos_profile=SERVICE_QUALITY)
    try:
        cloth.client.spin_until(service.service_is_ready, f'{name} is offered')
        # The node knows a client when it has answered it once.
        first = service.call_async(kind.Request(**fields(0)))
        cloth.client.spin_until(first.done, f'the first {name} is answered')
        futures = [
            service.call_async(kind.Request(**fields(number))) for number in range(at_once)]
        answered = cloth.client.spin_until(
            lambda: sum(map(_is_done, futures)) == at_once,
            f'{at_once} of {name} are answered')
        done = [getattr(future.result(), 'success', True) for future in futures]
        print(f'{name}: {at_once} sent, {answered and at_once} answered, {sum(done)} done')
        assert all(done) if is_each_done else any(done)
        assert all(future.result().message for future in futures if hasattr(
            future.result(), 'message'))
    finally:
        node.destroy_client(service)


@pytest.mark.parametrize('mode', ['mass_spring', pytest.param(
    'constraint', marks=pytest.mark.long), pytest.param('adaptive', marks=pytest.mark.long)])
def test_steps_that_take_long_starve_no_parameters(client, tmp_path, mode):
    """
    A cloth that is too large for the machine would keep its callers waiting for seconds.

    What concerns the cloth waits for the step under way: test/node/test_two_threads.py.
    """
    scene = {**SCENE, 'rows': 256, 'cols': 256, 'mode': mode}
    with NodeProcess(tmp_path, scene, '-r', '__ns:=/large') as node:
        state = client.watch(ClothState, '/large/cloth_sim/state', kept=True)
        client.spin_until(lambda: any(
            message.run_state == 'running' for message in state.messages), 'the run begins')
        took = []
        for _ in range(32):
            before = processor_time(node.pid)
            client.call(GetParameters, '/large/cloth_sim/get_parameters', names=['mode'])
            took.append((processor_time(node.pid) - before) * 1e3)
            client.spin_for(0.05)
        print(f'{mode}: ROS thread until an answer: median {np.median(took):.0f} ms, '
              f'p95 {np.percentile(took, 95):.0f} ms, longest {max(took):.0f} ms')
        # A client that has to wait for a processor of its own reads the answer later than it came.
        assert np.median(took) <= 20.0


def _is_done(future: Any) -> bool:
    return future.done()


@pytest.mark.parametrize('rounds', [5, pytest.param(200, marks=pytest.mark.long)])
def test_pauses_end_steps_wherever_they_come(cloth, rounds, seed):
    """Time would run on after an answer that says it stands, for as long as steps were asked."""
    drawn = random.Random(seed)
    cloth.call(SetBool, 'pause', data=True)
    service = cloth.client.service(Step, f'{cloth.name}/step')
    for _ in range(rounds):
        asked = drawn.choice([1, 7, 500, 20_000, 100_000])
        begin = cloth.call(Step, 'step', steps=1).sim_time
        steps = service.call_async(Step.Request(steps=asked))
        cloth.client.spin_for(drawn.uniform(0.0, 0.1))
        told = ''
        while not steps.done() and 'ends there' not in told:
            told = cloth.call(SetBool, 'pause', data=True).message
        cloth.client.spin_until(steps.done, 'the answer to the steps')
        answer = steps.result()
        made = round((answer.sim_time - begin) / cloth.dt)
        assert answer.success == (made == asked), answer.message
        if not answer.success:
            assert f'after {made} of {asked} steps' in told, (told, answer.message)
            assert f'after {made} of {asked}: request the other' in answer.message
        after = cloth.call(Step, 'step', steps=1).sim_time
        assert after == pytest.approx(answer.sim_time + cloth.dt)
