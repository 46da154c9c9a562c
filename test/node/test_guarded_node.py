# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A node that no callback can end, and that answers every request."""

import warnings

from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.node.guarded_node import Faults
from cloth_sim_ros.node.guarded_node import LateAnswers
from cloth_sim_ros.node.guarded_node import PATIENCE
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from cloth_under_test import SCENE
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import pytest
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger


def fault():
    """Return an exception with a trace."""
    try:
        raise KeyError('no such\nname')
    except KeyError as error:
        return error


def test_a_fault_is_counted_and_logged_with_its_trace():
    """A fault could not be reported, for want of the place it comes from."""
    logged = []
    faults = Faults(logged.append)
    line = faults.note(fault(), '~/reset')
    assert faults.count == 1
    assert line == faults.latest and line.startswith('~/reset: KeyError') and '\n' not in line
    assert 'raise KeyError' in logged[0] and 'the node continues' in logged[0]


def test_a_fault_of_every_frame_does_not_fill_the_disk():
    """A fault that comes 50 times a second would write a trace each time."""
    logged = []
    faults = Faults(logged.append)
    for _ in range(500):
        faults.note(fault(), 'a frame')
    faults.note(fault(), 'a step')
    assert len(logged) == 2 and faults.count == 501


# Answers reach callers that are discovered late; those that never are harm nobody.

# What rclpy warns of when the middleware knows no reader of the answer.
UNKNOWN = 'failed to send response (timeout): client will not receive response'


class Outbox:
    """What a service delivers: nothing to a caller before it is known."""

    def __init__(self) -> None:
        self.known: set[str] = set()
        self.delivered: list[tuple[str, str]] = []
        self.lost: list[str] = []
        self.is_awake = False
        self.now = 0.0
        self.late = LateAnswers(
            warn=self.lost.append, wait=lambda: self._set(True), rest=lambda: self._set(False),
            clock=lambda: self.now)

    def send(self, response, header):
        """Deliver as rclpy does."""
        if header in self.known:
            self.delivered.append((header, response))
        else:
            warnings.warn(UNKNOWN, RuntimeWarning)

    def answer(self, header, response='done'):
        """Answer the caller ``header``."""
        self.late.send('~/apply_push', self.send, response, header)

    def _set(self, is_awake: bool) -> None:
        self.is_awake = is_awake


def test_an_answer_waits_until_its_caller_is_known():
    """On a busy machine a caller that has just come would wait for ever."""
    outbox = Outbox()
    outbox.answer('first')
    outbox.answer('second')
    assert outbox.is_awake and not outbox.delivered
    outbox.late.retry()
    outbox.known.add('second')
    for _ in range(2):
        outbox.late.retry()
    assert outbox.delivered == [('second', 'done')] and outbox.is_awake
    outbox.known.add('first')
    outbox.late.retry()
    assert outbox.delivered == [('second', 'done'), ('first', 'done')]
    assert not outbox.is_awake and not outbox.lost


def test_an_answer_that_nobody_takes_is_given_up():
    """A caller that has gone would keep the node at work for ever."""
    outbox = Outbox()
    outbox.answer('gone')
    outbox.now = PATIENCE
    outbox.late.retry()
    assert not outbox.is_awake
    assert [line for line in outbox.lost if '~/apply_push' in line and 'QoS' in line]
    for number in range(100):
        outbox.answer(f'flood {number}')
    assert 1 < len(outbox.lost) < 100, 'answers without a caller fill the memory'


def test_other_warnings_are_kept():
    """What a service warns of would be lost with what is caught here."""
    outbox = Outbox()

    def send(response, header):
        warnings.warn('old', DeprecationWarning)

    with pytest.warns(DeprecationWarning, match='old'):
        outbox.late.send('~/apply_push', send, 'done', 'caller')
    assert not outbox.is_awake


def test_a_client_that_cannot_receive_holds_nobody_up(client, tmp_path):
    """One client with a foreign QoS would block the others, or leave no trace of why it waits."""
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/late') as node:
        cloth = ClothUnderTest(client, PAUSED, '/late/cloth_sim')
        push = ApplyPush.Request(force=Vector3(z=0.01), duration=0.01)
        deaf = client.node.create_client(
            ApplyPush, '/late/cloth_sim/apply_push', qos_profile=QoSProfile(
                depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL))
        assert cloth.call(ApplyPush, 'apply_push', force=push.force, duration=0.01).success
        futures = []
        # What is asked before the node has discovered the client is lost.
        while 'not delivered' not in node.output and len(futures) < 60:
            futures.append(deaf.call_async(push))
            for _ in range(5):
                assert cloth.call(
                    ApplyPush, 'apply_push', force=push.force, duration=0.01).success
            client.spin_for(2.0)
        assert 'not delivered' in node.output
        assert not any(future.done() for future in futures)
        assert cloth.call(ApplyPush, 'apply_push', force=push.force, duration=0.01).success
        client.node.destroy_client(deaf)


# A real node with a fault put into one of its parts: it answers, counts, and goes on.

START = """
from cloth_sim_ros.{module} import {name}
from cloth_sim_ros.node.main import main
import sys

def fails(*arguments, **options):
    {name}.calls += 1
    if {name}.calls in {when}:
        raise ZeroDivisionError('a fault put in by a test')
    return works(*arguments, **options)

works, {name}.calls, {name}.{method} = {name}.{method}, 0, fails
sys.exit(main())
"""
ALWAYS = 'range(10**9)'


def with_fault(module, name, method, when=ALWAYS):
    """Return the program of a node with a fault in one method, in those calls of it."""
    return START.format(module=module, name=name, method=method, when=when)


def status_of(cloth, faults=1):
    """Return what /diagnostics says of the program after so many faults."""
    found = cloth.wait_for('diagnostics', lambda array: any(
        status.name.endswith('program') and status.level == status.WARN
        and status.message.startswith(f'{faults} unexpected error')
        for status in array.status))
    return next(status for status in found.status if status.name.endswith('program'))


@pytest.mark.parametrize('service, kind, method', [
    ('apply_push', ApplyPush, '_apply'),
    pytest.param('clear_pushes', Trigger, '_clear', marks=pytest.mark.long)])
def test_a_request_that_fails_is_answered(client, tmp_path, service, kind, method):
    """The node would end, or the caller wait for ever for an answer."""
    start = with_fault('node.load_requests', 'LoadRequests', method)
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/fails', start=start) as node:
        cloth = ClothUnderTest(client, PAUSED, '/fails/cloth_sim')
        for _ in range(2):
            answer = cloth.call(kind, service)
            assert not answer.success and 'ZeroDivisionError' in answer.message
            assert getattr(answer, 'code', ResultCode.UNEXPECTED) == ResultCode.UNEXPECTED
        assert service in status_of(cloth, faults=2).message
        assert cloth.call(Step, 'step', steps=1).success
        assert node.output.count('Traceback') == 1, 'a fault that comes again is not logged again'
        assert 'a fault put in by a test' in node.output


def test_a_coroutine_that_fails_is_answered(client, tmp_path):
    """The caller of a service that waits for the end of a step would wait for ever."""
    start = with_fault('node.cloth_sim_node', 'ClothSimNode', '_reset', 'range(2)')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/later', start=start):
        cloth = ClothUnderTest(client, SCENE, '/later/cloth_sim')
        cloth.wait_for('stats')
        answer = cloth.call(Trigger, 'reset')
        assert not answer.success and 'ZeroDivisionError' in answer.message
        cloth.clear()
        cloth.wait_for('stats')
        assert cloth.call(Trigger, 'reset').success


def test_a_message_that_fails_is_left_out(client, tmp_path):
    """A message on a topic would end the node."""
    start = with_fault('node.load_requests', 'LoadRequests', '_on_push', '(1,)')
    with NodeProcess(tmp_path, PAUSED, '-r', '__ns:=/topic', start=start):
        cloth = ClothUnderTest(client, PAUSED, '/topic/cloth_sim')
        publisher = client.node.create_publisher(Push, '/topic/cloth_sim/push', 10)
        client.spin_until(publisher.get_subscription_count, 'the node listens')
        for _ in range(2):
            publisher.publish(Push(force=Vector3(z=1.0), duration=1.0))
        assert cloth.wait_for('inputs/push').force.z == 1.0
        assert '~/push' in status_of(cloth).message
        assert len(cloth['inputs/push']) == 1


def test_a_step_that_fails_stops_the_run(client, tmp_path):
    """A fault in a step would end the node, or be tried again for ever in silence."""
    start = with_fault('sim.simulation', 'Simulation', '_make_steps', '(20,)')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/step', start=start) as node:
        cloth = ClothUnderTest(client, SCENE, '/step/cloth_sim')
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        assert 'the run failed unexpectedly' in node.output and 'Traceback' in node.output
        assert status_of(cloth)
        assert cloth.call(SetBool, 'pause', data=False).success
        cloth.wait_for('stats', lambda stats: stats.steps > 40)


def test_a_device_that_is_lost_stops_the_run(client, tmp_path):
    """The node would end when the driver resets the GPU, or hand out what is left in memory."""
    start = with_fault('sim.guarded_steps', 'BoundsCheck', 'passes', 'range(20, 10**9)').replace(
        'import sys', 'import sys\nfrom cloth_sim_ros.gl.errors import DeviceError').replace(
        'ZeroDivisionError', 'DeviceError')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/lost', start=start) as node:
        cloth = ClothUnderTest(client, SCENE, '/lost/cloth_sim')
        cloth.wait_for('state', lambda state: state.run_state == 'stopped')
        assert 'a fault put in by a test' in node.output
        assert 'unexpected' not in node.output
        cloth.wait_for('diagnostics', lambda array: any(
            'a fault put in by a test' in status.message for status in array.status))
        assert cloth.call(Trigger, 'clear_pushes').success


@pytest.mark.parametrize('method', ['frame', '_send_frame'])
def test_a_frame_that_fails_is_left_out(client, tmp_path, method):
    """A frame that cannot be made would stop all that come after it."""
    start = with_fault('node.reports', 'Reports', method, '(4,)')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/frame', start=start) as node:
        cloth = ClothUnderTest(client, SCENE, '/frame/cloth_sim')
        client.spin_until(lambda: 'unexpected error in a frame' in node.output, 'the fault')
        begin = cloth.wait_for('stats', lambda stats: stats.steps > 10).steps
        cloth.clear()
        cloth.wait_for('stats', lambda stats: stats.steps > begin + 60)
        assert node.output.count('unexpected error in a frame') == 1


def test_a_fault_at_the_start_ends_the_node(tmp_path):
    """A node whose first mode cannot be prepared would stay there and do nothing."""
    start = with_fault('sim.engine', 'Preparation', 'run').replace(
        'raise ZeroDivisionError', 'arguments[0].error = ValueError').replace(
        'return works', 'return; works')
    with NodeProcess(tmp_path, SCENE, '-r', '__ns:=/start', start=start) as node:
        assert node.wait() == 1
        assert 'a fault put in by a test' in node.output
