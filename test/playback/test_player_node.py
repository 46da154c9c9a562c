# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The clock that a recording is played with."""

from signal import SIGCONT
from signal import SIGSTOP
import subprocess
import sys
from threading import Timer

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.playback.player_node import SimulatedClock
from rclpy.serialization import serialize_message

STAMPS = 2000
READER = f"""
import rclpy
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
rclpy.init()
node = rclpy.create_node('clock_reader')
received = []
node.create_subscription(
    Clock, '/clock', lambda message: received.append(message.clock.sec), QoSProfile(depth=1000))
print('ready', flush=True)
while not received or received[-1] != {STAMPS}:
    rclpy.spin_once(node, timeout_sec=0.1)
print(*received)
"""


def test_a_reader_that_is_held_up_for_a_while_gets_every_stamp(client):
    """A node with use_sim_time would see time leap where its machine was busy."""
    with subprocess.Popen(
            [sys.executable, '-c', READER], stdout=subprocess.PIPE, text=True) as reader:
        try:
            reader.stdout.readline()
            clock = SimulatedClock(client.node, patience=60.0)
            client.spin_until(
                lambda: client.node.count_subscribers('/clock'), 'the reader is found')
            client.spin_for(0.3)
            reader.send_signal(SIGSTOP)
            Timer(0.1, reader.send_signal, (SIGCONT,)).start()
            for number in range(1, STAMPS + 1):
                stats = ClothStats()
                stats.header.stamp = Time(sec=number)
                clock.read(ClothStats, serialize_message(stats))
            seconds, _ = reader.communicate(timeout=60.0)
        finally:
            reader.kill()
    assert [int(each) for each in seconds.split()] == list(range(1, STAMPS + 1))
