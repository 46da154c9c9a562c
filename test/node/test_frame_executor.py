# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The executor serves what rclpy's own does."""

from threading import Timer
import time

from cloth_sim_interfaces.action import Step
from cloth_sim_ros.node.frame_executor import FrameExecutor
import rclpy
from rclpy.action import ActionClient
from rclpy.action import ActionServer
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger

PATIENCE = 300.0


def spin_until(executor, condition):
    """Spin until ``condition`` holds, for a while."""
    end = time.monotonic() + PATIENCE
    while not condition() and time.monotonic() < end:
        executor.spin_once(0.1)
    return condition()


def test_every_kind_of_entity_is_served(lone_node):
    """A request, a message or a timer would be forgotten beside the others."""
    heard, answered, ticks = [], [], []

    def answer(_, response):
        answered.append(1)
        return response

    executor = FrameExecutor(lone_node)
    lone_node.create_service(Trigger, '~/serve', answer)
    lone_node.create_subscription(String, '~/text', lambda _: heard.append(1), 10)
    lone_node.create_timer(0.01, lambda: ticks.append(1))
    client = lone_node.create_client(Trigger, '~/serve')
    publisher = lone_node.create_publisher(String, '~/text', 10)
    assert spin_until(executor, client.service_is_ready)
    assert spin_until(executor, lambda: publisher.get_subscription_count() == 1)
    future = client.call_async(Trigger.Request())
    publisher.publish(String())
    assert spin_until(executor, lambda: future.done() and heard and ticks and answered)


def test_an_action_is_served(lone_node):
    """A goal would wait until something else wakes the node."""
    def execute(handle):
        handle.publish_feedback(Step.Feedback(steps=1))
        handle.succeed()
        return Step.Result(steps=2)

    executor = FrameExecutor(lone_node)
    ActionServer(lone_node, Step, 'steps', execute)
    asker = rclpy.create_node('asker', context=lone_node.context)
    answers = SingleThreadedExecutor(context=lone_node.context)
    answers.add_node(asker)
    client = ActionClient(asker, Step, 'steps')

    def wait(future):
        def is_done():
            answers.spin_once(0.01)
            return future.done()

        assert spin_until(executor, is_done)
        return future.result()

    assert spin_until(executor, client.server_is_ready)
    goal = wait(client.send_goal_async(Step.Goal()))
    assert wait(goal.get_result_async()).result.steps == 2
    client.destroy()
    answers.shutdown()
    asker.destroy_node()


def test_entities_that_come_late_are_waited_for(lone_node):
    """A topic that is subscribed to at run time, as of a grasp, would stay silent."""
    executor = FrameExecutor(lone_node)
    executor.spin_once(0.0)
    ticks = []
    timer = lone_node.create_timer(0.01, lambda: ticks.append(1))
    assert spin_until(executor, lambda: len(ticks) > 2)
    lone_node.destroy_timer(timer)
    executor.spin_once(0.0)


def test_a_guard_condition_of_another_thread_is_served_once(lone_node):
    """A mode compiled on a thread would not take over, or a fault be reported for ever."""
    executor = FrameExecutor(lone_node)
    called = []
    condition = lone_node.create_guard_condition(lambda: called.append(1))
    trigger = Timer(0.2, condition.trigger)
    trigger.start()
    assert spin_until(executor, lambda: called)
    trigger.join()
    for _ in range(5):
        executor.spin_once(0.01)
    assert len(called) == 1


def test_coroutines_are_finished(lone_node):
    """A request that is answered later, as ~/step, would never be."""
    executor = FrameExecutor(lone_node)
    waited = rclpy.task.Future(executor=executor)

    async def answer(_, response):
        await waited
        response.success = True
        return response

    lone_node.create_service(Trigger, '~/later', answer)
    client = lone_node.create_client(Trigger, '~/later')
    assert spin_until(executor, client.service_is_ready)
    future = client.call_async(Trigger.Request())
    for _ in range(20):
        executor.spin_once(0.01)
    assert not future.done()
    waited.set_result(None)
    assert spin_until(executor, future.done)
    assert future.result().success


def test_what_a_guard_condition_brings_is_answered_at_once(lone_node):
    """An answer would wait for the next timer, up to a second."""
    brought = rclpy.task.Future()

    async def wait():
        await brought

    executor = FrameExecutor(lone_node)
    condition = lone_node.create_guard_condition(lambda: brought.set_result(None))
    task = executor.create_task(wait)
    executor.spin_once(0.0)
    assert not task.done()
    condition.trigger()
    # Nothing else comes: another turn would sleep for ever.
    executor.spin_once(None)
    assert brought.done() and task.done()


def test_a_task_that_waits_is_not_asked_again_and_again(lone_node):
    """The thread that steps would lose time to one that only asks."""
    polls, ticks = [], []

    class Wait:
        def __await__(self):
            while len(ticks) < 5:
                polls.append(1)
                yield

    async def wait():
        await Wait()

    executor = FrameExecutor(lone_node)
    task = executor.create_task(wait)
    lone_node.create_timer(0.05, lambda: ticks.append(1))
    while not task.done():
        executor.spin_once()
    # In that time, a loop that never sleeps would have asked thousands of times.
    assert len(polls) < 10 * len(ticks)
