# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Answers reach callers that are discovered late; those that never are harm nobody."""

import warnings

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_ros.node.late_answers import LateAnswers
from cloth_sim_ros.node.late_answers import PATIENCE
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from geometry_msgs.msg import Vector3
from node_process import NodeProcess
import pytest
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile

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
