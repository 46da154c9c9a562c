# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages that go to the middleware past rclpy."""

import sys
import threading
import time

from cloth_sim_ros.node.quick_publish import publish
import pytest
import rclpy
from rclpy._rclpy_pybind11 import InvalidHandle
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from std_msgs.msg import UInt8MultiArray

PATIENCE = 300.0


@pytest.mark.parametrize('size', [0, 1, 100_000])
def test_messages_arrive_whole(lone_node, size):
    """A length or an address that is off by one would be a crash, or another message."""
    heard = []
    lone_node.create_subscription(UInt8MultiArray, '~/bytes', heard.append, QoSProfile(depth=10))
    publisher = lone_node.create_publisher(UInt8MultiArray, '~/bytes', QoSProfile(depth=10))
    executor = SingleThreadedExecutor(context=lone_node.context)
    executor.add_node(lone_node)
    end = time.monotonic() + PATIENCE
    while not publisher.get_subscription_count() and time.monotonic() < end:
        executor.spin_once(0.1)
    sent = [UInt8MultiArray(data=bytes([number]) * size) for number in range(5)]
    for message in sent:
        publish(publisher, serialize_message(message))
    while len(heard) < len(sent) and time.monotonic() < end:
        executor.spin_once(0.1)
    assert heard == sent


def test_another_thread_works_meanwhile(lone_node):
    """The device thread would stand still while the middleware copies a message."""
    lone_node.create_subscription(UInt8MultiArray, '~/bytes', print, QoSProfile(depth=1))
    publisher = lone_node.create_publisher(UInt8MultiArray, '~/bytes', QoSProfile(depth=1))
    end = time.monotonic() + PATIENCE
    while not publisher.get_subscription_count() and time.monotonic() < end:
        time.sleep(0.01)
    data = serialize_message(UInt8MultiArray(data=bytes(30_000_000)))
    counts, is_over = [0], threading.Event()

    def count():
        while not is_over.is_set():
            counts[0] += 1
            time.sleep(1e-5)  # which lets go of the lock

    thread, interval = threading.Thread(target=count), sys.getswitchinterval()
    # Nobody is made to let go of it.
    sys.setswitchinterval(1000.0)
    thread.start()
    try:
        while not counts[0]:
            time.sleep(0.001)
        before = counts[0]
        # On a busy machine the thread may not get a processor within one of them.
        for _ in range(200):
            publish(publisher, data)
            if counts[0] > before:
                break
        assert counts[0] > before
    finally:
        is_over.set()
        sys.setswitchinterval(interval)
        thread.join()


def test_a_publisher_that_is_gone_is_an_error(lone_node):
    """A null pointer would end the process."""
    publisher = lone_node.create_publisher(UInt8MultiArray, '~/bytes', QoSProfile(depth=1))
    data = serialize_message(UInt8MultiArray())
    lone_node.destroy_publisher(publisher)
    with pytest.raises(InvalidHandle):
        publish(publisher, data)
    publisher = lone_node.create_publisher(UInt8MultiArray, '~/bytes', QoSProfile(depth=1))
    rclpy.shutdown(context=lone_node.context)
    for _ in range(2):
        with pytest.raises(RCLError, match='context'):
            publish(publisher, data)
