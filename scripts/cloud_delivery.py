#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Count the clouds that reach a subscriber, with and without the node's shared memory.

    python scripts/cloud_delivery.py
    python scripts/cloud_delivery.py --sizes 316 --rate 60 --seconds 20
    python scripts/cloud_delivery.py --sizes 280 --reliable --busy 8

The subscriber is this process: best effort with a depth of 5 or, as rclpy's wait_for_message,
reliable with a depth of 1, and nothing set up for large messages.
The node steps a cloth without springs, in real time. Prints a table in Markdown.
"""

from argparse import ArgumentParser
from collections.abc import Iterator
from contextlib import contextmanager
import json
import os
from pathlib import Path
import subprocess
import sys
from tempfile import NamedTemporaryFile
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.node.shared_memory import VARIABLE
from cloth_sim_ros.playback.played_topics import header_stamp
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import SetBool

ROOT = Path(__file__).resolve().parents[1]
PATIENCE = 30.0
# Always the same: with another time, the executor begins anew, and clouds take every turn.
TURN = 0.05
NANOSECONDS = 10**9
# The node leaves a profile that somebody has named as it is.
EMPTY_PROFILE = """<?xml version="1.0" encoding="UTF-8"?>
<profiles xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <participant profile_name="nothing" is_default_profile="true"><rtps/></participant>
</profiles>
"""


@contextmanager
def cloth_node(size: int, rate: float, profile: bool) -> Iterator[None]:
    """Run a paused node of ``size`` x ``size`` nodes; without its profile on demand."""
    given = {
        'rows': size, 'cols': size, 'dt': 1.0 / rate, 'publish.rate': rate, 'start_paused': True,
        'publish.markers': False, 'auto_substeps': False,
        **{f'{kind}.{family}': 0.0 for kind in ('stiffness', 'damping')
           for family in ('structural', 'shear', 'bend')}}
    options = [
        part for name, value in given.items() for part in ('-p', f'{name}:={json.dumps(value)}')]
    with NamedTemporaryFile('w', suffix='.xml') as empty:
        empty.write(EMPTY_PROFILE)
        empty.flush()
        process = subprocess.Popen(
            [sys.executable, '-m', 'cloth_sim_ros.node', '--ros-args', '--log-level', 'fatal',
             *options],
            env={**os.environ} if profile else {**os.environ, VARIABLE: empty.name})
        try:
            yield
        finally:
            process.terminate()
            process.wait(PATIENCE)


@contextmanager
def load(processes: int) -> Iterator[None]:
    """Keep so many processes busy besides."""
    busy = [subprocess.Popen([sys.executable, '-c', 'while True: pass'])
            for _ in range(processes)]
    try:
        yield
    finally:
        for process in busy:
            process.kill()
            process.wait(PATIENCE)


def count(node: Node, seconds: float, quality: QoSProfile) -> tuple[int, int]:
    """Let the cloth run and return the clouds that came and the frames that there were."""
    clouds, frames = set(), set()
    node.create_subscription(
        PointCloud2, '/cloth_sim/points', lambda data: clouds.add(_time(header_stamp(data))),
        quality, raw=True)
    node.create_subscription(
        ClothStats, '/cloth_sim/stats', lambda stats: frames.add(_time(stats.header.stamp)), 1000)
    pause = node.create_client(SetBool, '/cloth_sim/pause')
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    # A paused node shows its cloth once a second: then both know each other.
    end = time.monotonic() + PATIENCE
    while not (frames and pause.service_is_ready()) and time.monotonic() < end:
        executor.spin_once(timeout_sec=TURN)
    for paused, duration in ((False, seconds), (True, 1.0)):
        pause.call_async(SetBool.Request(data=paused))
        end = time.monotonic() + duration
        while time.monotonic() < end:
            executor.spin_once(timeout_sec=TURN)
    # The first and the last frame are shown again while paused.
    running = frames - {min(frames), max(frames)}
    return len(running & clouds), len(running)


def _time(stamp: object) -> int:
    return stamp.sec * NANOSECONDS + stamp.nanosec


def measure(
        size: int, rate: float, seconds: float, profile: bool, quality: QoSProfile) -> str:
    """Return how many clouds came, in words."""
    with cloth_node(size, rate, profile):
        rclpy.init()
        node = rclpy.create_node('cloud_delivery')
        came, sent = count(node, seconds, quality)
        node.destroy_node()
        rclpy.shutdown()
    return f'{came} of {sent} ({came / max(sent, 1):.0%})'


def main() -> int:
    """Measure and print the table."""
    parser = ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--sizes', nargs='+', type=int, default=[64, 128, 256, 512])
    parser.add_argument('--rate', type=float, default=30.0, help='clouds in a second')
    parser.add_argument('--seconds', type=float, default=8.0, help='of each run')
    parser.add_argument(
        '--reliable', action='store_true', help='subscribe reliably, with a depth of 1')
    parser.add_argument('--busy', type=int, default=0, help='processes that load the machine')
    args = parser.parse_args()
    quality = QoSProfile(depth=1) if args.reliable else QoSProfile(
        depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)
    os.environ.pop(VARIABLE, None)
    # A graph of its own: nobody else's clouds are counted.
    os.environ['ROS_DOMAIN_ID'] = subprocess.check_output(
        [sys.executable, ROOT / 'scripts' / 'free_ros_domain.py'], text=True).strip()
    print('| nodes | a cloud has | without the profile | with it |')
    print('|---|---|---|---|', flush=True)
    for size in args.sizes:
        with load(args.busy):
            told = [measure(size, args.rate, args.seconds, profile, quality)
                    for profile in (False, True)]
        print(f'| {size} x {size} | {size**2 * POINT_DTYPE.itemsize / 1e6:.2g} MB | '
              f'{told[0]} | {told[1]} |', flush=True)
    return 0


if __name__ == '__main__':
    sys.exit(main())
