#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Record the example that bags/README.md walks through: a node, and what was done to its cloth.

    python scripts/example_recording.py bags/example

A cloth of 16 x 16 nodes hangs from two corners. It is pushed at 0.6 s, switched to mode constraint
at 1.2 s, and let go at its top left corner at 2 s: each as soon as the node reports a frame of
that time, so that the inputs of a new recording may come a few hundredths of a second later.
"""

from argparse import ArgumentParser
from contextlib import contextmanager
import json
import os
from pathlib import Path
import shutil
import subprocess
import sys
from tempfile import TemporaryDirectory

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.verb.node_client import NodeClient
from geometry_msgs.msg import Vector3
from rclpy.qos import QoSProfile
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger

ROOT = Path(__file__).resolve().parents[1]
PARAMETERS = {
    'rows': 16, 'cols': 16, 'start.pose': 'hanging', 'publish.rate': 20.0, 'start_paused': True,
    'recording.enabled': True}
PATIENCE = 30.0

# What is done, and at which simulated time [s].
ACTIONS = [
    (0.6, ApplyPush, 'apply_push', ApplyPush.Request(force=Vector3(y=1.5), duration=0.2)),
    (1.2, SetMode, 'set_mode', SetMode.Request(mode='constraint')),
    (2.0, SetPin, 'set_pin', SetPin.Request(row=0, col=0, release=True)),
    (2.8, Trigger, 'stop_recording', Trigger.Request()),
]


@contextmanager
def recording_node(folder: Path):
    """Run a paused node that records into ``folder``."""
    given = {
        **PARAMETERS, 'recording.directory': str(folder.parent), 'recording.name': folder.name}
    options = [
        part for name, value in given.items() for part in ('-p', f'{name}:={json.dumps(value)}')]
    process = subprocess.Popen([
        sys.executable, '-m', 'cloth_sim_ros.node', '--ros-args',
        '--params-file', ROOT / 'config' / 'studies' / 'two_corners.yaml', *options])
    try:
        yield
    finally:
        process.terminate()
        process.wait(PATIENCE)


def act(client: NodeClient) -> None:
    """Let the cloth go, do to it what is to be done, and end the recording."""
    client.call(SetBool, 'pause', SetBool.Request(data=False))
    for due, kind, name, request in ACTIONS:
        client.read(ClothStats, 'stats', QoSProfile(depth=10), lambda stats: _time(stats) >= due)
        client.call(kind, name, request)


def _time(stats: ClothStats) -> float:
    return stats.header.stamp.sec + 1e-9 * stats.header.stamp.nanosec


def main() -> int:
    """Record, and say where."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('folder', type=Path, help='of the recording; must not be there yet')
    folder = parser.parse_args().folder
    if folder.exists():
        parser.error(f'{folder} is there already: remove it first')
    # A graph of its own: nobody else's node is pushed.
    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = 'LOCALHOST'
    os.environ['ROS_DOMAIN_ID'] = subprocess.check_output(
        [sys.executable, ROOT / 'scripts' / 'free_ros_domain.py'], text=True).strip()
    # A recording tells its own path: one that says nothing of this machine.
    with TemporaryDirectory() as scratch:
        made = Path(scratch) / folder.name
        with recording_node(made), NodeClient('cloth_sim', PATIENCE) as client:
            act(client)
        shutil.move(made, folder)
    print(folder)
    return 0


if __name__ == '__main__':
    sys.exit(main())
