# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The executor serves what rclpy's own does, and rings its alarm in between."""

from threading import Thread
from threading import Timer
import time

from cloth_sim_ros.node.frame_executor import Alarm
from cloth_sim_ros.node.frame_executor import FrameExecutor
import pytest
import rclpy
from rclpy.context import Context
from std_msgs.msg import String
from std_srvs.srv import Trigger

PATIENCE = 300.0


@pytest.fixture
def node():
    """Lend a node in a graph of its own context."""
    context = Context()
    rclpy.init(context=context)
    made = rclpy.create_node('frame_executor_under_test', context=context)
    yield made
    made.destroy_node()
    rclpy.try_shutdown(context=context)


def spin_until(executor, condition):
    """Spin until ``condition`` holds, for a while."""
    end = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < end:
        executor.spin_once(0.1)
    return condition()


def test_an_alarm_rings_until_it_is_set_anew():
    """A frame would never be made, or the same one again and again."""
    alarm = Alarm(lambda: None)
    assert alarm.left is None
    alarm.ring_in(100.0)
    assert 0.0 < alarm.left <= 100.0
    alarm.ring_in(0.0)
    assert alarm.left == 0.0
    alarm.cancel()
    assert alarm.left is None


def test_the_alarm_rings_while_everything_else_is_served(node):
    """A running cloth would keep its node from answering, or requests the cloth from running."""
    rung, heard, answered = [], [], []

    def answer(_, response):
        answered.append(1)
        return response

    def ring():
        rung.append(1)
        alarm.ring_in(0.0)

    alarm = Alarm(ring)
    alarm.ring_in(0.0)
    executor = FrameExecutor(node, alarm)
    node.create_service(Trigger, '~/serve', answer)
    node.create_subscription(String, '~/text', lambda _: heard.append(1), 10)
    ticks = []
    node.create_timer(0.01, lambda: ticks.append(1))
    client = node.create_client(Trigger, '~/serve')
    publisher = node.create_publisher(String, '~/text', 10)
    assert spin_until(executor, client.service_is_ready)
    assert spin_until(executor, lambda: publisher.get_subscription_count() == 1)
    future = client.call_async(Trigger.Request())
    publisher.publish(String())
    before = len(rung)
    assert spin_until(executor, lambda: future.done() and heard and ticks and answered)
    assert len(rung) > before


def test_entities_that_come_late_are_waited_for(node):
    """A topic that is subscribed to at run time, as of a grasp, would stay silent."""
    executor = FrameExecutor(node, Alarm(lambda: None))
    executor.spin_once(0.0)
    ticks = []
    timer = node.create_timer(0.01, lambda: ticks.append(1))
    assert spin_until(executor, lambda: len(ticks) > 2)
    node.destroy_timer(timer)
    executor.spin_once(0.0)


def test_a_guard_condition_of_another_thread_is_served_once(node):
    """A mode compiled on a thread would not take over, or a fault be reported for ever."""
    executor = FrameExecutor(node, Alarm(lambda: None))
    called = []
    condition = node.create_guard_condition(lambda: called.append(1))
    trigger = Timer(0.2, condition.trigger)
    trigger.start()
    assert spin_until(executor, lambda: called)
    trigger.join()
    for _ in range(5):
        executor.spin_once(0.01)
    assert len(called) == 1


def test_coroutines_are_finished(node):
    """A request that is answered later, as ~/step, would never be."""
    executor = FrameExecutor(node, Alarm(lambda: None))
    waited = rclpy.task.Future(executor=executor)

    async def answer(_, response):
        await waited
        response.success = True
        return response

    node.create_service(Trigger, '~/later', answer)
    client = node.create_client(Trigger, '~/later')
    assert spin_until(executor, client.service_is_ready)
    future = client.call_async(Trigger.Request())
    for _ in range(20):
        executor.spin_once(0.01)
    assert not future.done()
    waited.set_result(None)
    assert spin_until(executor, future.done)
    assert future.result().success


def test_what_the_alarm_brings_is_answered_at_once(node):
    """An answer to ~/step would wait for the next timer, up to a second, where steps take long."""
    brought = rclpy.task.Future()
    rings = []

    def ring():
        rings.append(1)
        if len(rings) == 3:
            brought.set_result(None)
            alarm.cancel()

    async def wait():
        await brought

    alarm = Alarm(ring)
    executor = FrameExecutor(node, alarm)
    task = executor.create_task(wait)
    alarm.ring_in(0.0)
    for _ in range(3):
        executor.spin_once(0.0)
    assert brought.done() and not task.done()
    # Nothing else comes, so that it may sleep for ever; the end of the context wakes it then.
    turn = Thread(target=executor.spin_once, daemon=True)
    turn.start()
    turn.join(PATIENCE)
    assert task.done()
