# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Clients that call everything with anything."""

from collections import Counter
from collections.abc import Iterator
import random
import time
from typing import Any

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_under_test import ClothUnderTest
from cloth_under_test import SCENE
from cloth_under_test import SERVICES
from geometry_msgs.msg import PointStamped
from hostile import fill
from node_process import NodeProcess
import numpy as np
from processor_time import processor_time
from processor_time import waited_for_a_processor
import pytest
from rcl_interfaces.srv import GetParameterTypes
from rcl_interfaces.srv import SetParameters
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

ALL_SERVICES = {
    **SERVICES, 'set_parameters': SetParameters, 'get_parameter_types': GetParameterTypes}
TOPICS = {'~/push': Push, '~/pins/target': PinTarget, '/clicked_point': PointStamped}
# Parts of a refusal that separate the rule and the value from the advice.
WAYS_OUT = (': ', 'must be one of', 'must be true or false')
# Topics on which accepted requests are published, by service.
TOLD = {
    'apply_push': 'inputs/push', 'set_pin': 'inputs/pin', 'move_pin': 'inputs/pin_target',
    'clear_pushes': 'inputs/command'}
LONGEST_ANSWER = 600
# Waits for what it asks for, by the purpose of the service.
_SLOW = ('step', 'set_mode', 'reset', 'start_recording')


class Attacker:
    """Draw calls and messages, and keep how they were answered."""

    def __init__(self, cloth: ClothUnderTest, node: NodeProcess, seed: int) -> None:
        """Find all services, and offer all topics."""
        self.cloth, self.node = cloth, node
        self.drawn = random.Random(seed)
        self.answered: Counter[str] = Counter()
        self.refused: Counter[str] = Counter()
        self.done: Counter[str] = Counter()
        self.took: list[float] = []
        self.bad: set[str] = set()
        client = cloth.client
        self._clients = {
            name: client.service(kind, f'{cloth.name}/{name}')
            for name, kind in ALL_SERVICES.items()}
        self._publishers = {
            name: client.node.create_publisher(kind, name.replace('~', cloth.name), 10)
            for name, kind in TOPICS.items()}
        client.spin_until(
            lambda: all(each.get_subscription_count() for each in self._publishers.values()),
            'the node listens')

    def attack(self) -> None:
        """Make one call, or several at once, or send a message, or bytes that are none."""
        kind = self.drawn.random()
        if kind < 0.1:
            self._send(self.drawn.choice(list(self._publishers)))
        elif kind < 0.13:
            self._publishers[self.drawn.choice(list(self._publishers))].publish(
                self.drawn.randbytes(self.drawn.choice((0, 1, 4, 5, 40, 1000))))
        elif kind < 0.2:
            self._call([self.drawn.choice(list(self._clients)) for _ in range(8)])
        else:
            self._call([self.drawn.choice(list(self._clients))])

    def call_each(self) -> None:
        """Call each service once, so that chance leaves none of them out."""
        for name in self._clients:
            self._call([name])

    def check(self) -> None:
        """Fail where what was accepted is not told, or what was sent is not finite."""
        cloth = self.cloth
        for name, key in TOLD.items():
            cloth.client.spin_until(
                lambda: len(cloth[key]) >= self.done[name],
                f'{self.done[name]} accepted calls of {name} are published on {key}')
        for stats in cloth['stats']:
            assert np.isfinite(
                [stats.total_energy, stats.max_strain, stats.real_time_factor]).all()
        for cloud in cloth['points']:
            points = cloth.points_of(cloud)
            assert all(np.isfinite(points[name]).all() for name in points.dtype.names)

    def bring_back(self) -> None:
        """Undo what lets a run stand still, which is not what is looked for."""
        call = self.cloth.call
        assert call(Trigger, 'clear_pushes').success
        assert self.cloth.set_parameters(
            real_time_factor=1.0, publish__points=True, publish__stats=True).successful
        assert call(Trigger, 'reset').success
        assert call(SetBool, 'pause', data=False).success
        self.cloth.clear()
        self.done.clear()
        self.cloth.wait_for('stats', lambda stats: stats.steps > 3)
        self.cloth.wait_for('points')

    def _send(self, name: str) -> None:
        self._publishers[name].publish(fill(TOPICS[name](), self.drawn, 0.6))

    def _call(self, names: list[str]) -> None:
        before, waited = processor_time(self.node.pid), waited_for_a_processor()
        pending = [
            (name, self._clients[name].call_async(
                fill(ALL_SERVICES[name].Request(), self.drawn, 0.6))) for name in names]
        for name, future in pending:
            if name == 'step':
                self._end_steps(future)
            self.cloth.client.spin_until(future.done, f'{name} answers')
            self._judge(name, future.result())
        if len(names) == 1 and names[0] not in _SLOW:
            # While this process waits for a processor, the node runs on.
            waited = waited_for_a_processor() - waited
            self.took.append(max(processor_time(self.node.pid) - before - waited, 0.0))

    def _end_steps(self, future: Any) -> None:
        """Put the cloth back, which ends them: 100000 steps would take minutes."""
        for _ in range(60):
            self.cloth.client.spin_for(0.2)
            if future.done():
                return
            assert self.cloth.call(Trigger, 'reset').success

    def _judge(self, name: str, response: Any) -> None:
        self.answered[name] += 1
        self.done[name] += getattr(response, 'success', False)
        for reason in _refusals(response):
            self.refused[name] += 1
            if not any(way in reason for way in WAYS_OUT):
                self.bad.add(f'{name}: no way out in {reason!r}')
            if len(reason) > LONGEST_ANSWER:
                self.bad.add(f'{name}: {len(reason)} characters, {reason[:80]!r}')
            if 'unexpected' in reason:
                self.bad.add(f'{name}: {reason}')


def _refusals(response: Any) -> Iterator[str]:
    if hasattr(response, 'success') and not response.success:
        yield response.message
    results = getattr(response, 'results', [])
    results = results or [each for each in [getattr(response, 'result', None)] if each]
    for result in results:
        if not getattr(result, 'successful', True):
            yield result.reason


def attack(cloth: ClothUnderTest, node: NodeProcess, seed: int, calls: int) -> Attacker:
    """Make ``calls``, and check what has come of them now and then."""
    for mode in MODES:  # outside of shader compiles
        assert cloth.call(SERVICES['set_mode'], 'set_mode', mode=mode).success
    attacker = Attacker(cloth, node, seed)
    attacker.call_each()
    for number in range(calls):
        attacker.attack()
        assert node.running, node.output[-3000:]
        if number % 100 == 99:
            attacker.check()
            attacker.bring_back()
    return attacker


@pytest.mark.parametrize('calls', [150, pytest.param(10_000, marks=pytest.mark.long)])
def test_no_call_ends_the_node_or_goes_unanswered(client, tmp_path, seed, calls):
    """A client could end the node, or be left without an answer or without the way out."""
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/attacked') as node:
        cloth = ClothUnderTest(client, SCENE, '/attacked/cloth_sim')
        begin = time.monotonic()
        attacker = attack(cloth, node, seed, calls)
        lasted = time.monotonic() - begin
        cloth.clear()
        found = cloth.wait_for('diagnostics')
        [program] = [each for each in found.status if each.name.endswith('program')]
        took = np.array(attacker.took) * 1e3
        print(
            f'{sum(attacker.answered.values())} answers, of which '
            f'{sum(attacker.refused.values())} refusals, in {lasted:.0f} s; processor time until '
            f'an answer: p95 {np.percentile(took, 95):.1f} ms, longest {took.max():.1f} ms; '
            f'{program.message}')
        assert not attacker.bad, '\n'.join(sorted(attacker.bad))
        assert set(attacker.answered) == set(ALL_SERVICES)
        # Bytes that are no message are noted by the executor, and nothing else is.
        others = node.output.replace('unexpected error in the executor', '')
        assert 'unexpected error' not in others
        assert np.percentile(took, 95) <= 60.0 and took.max() <= 500.0
    assert node.wait() == 0
