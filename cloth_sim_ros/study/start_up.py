# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long a new node takes to its first published cloud."""

from collections.abc import Mapping
import json
import subprocess
import sys
import tempfile
import time
from typing import Any

from cloth_sim_ros.files.errors import MOST_SHOWN
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
import rclpy
from sensor_msgs.msg import PointCloud2

_DEPTH = 10
_NODE_NAME = 'cloth_sim_start_up'


def time_to_first_cloud(
        parameter_file: str, changes: Mapping[str, Any], timeout: float) -> float:
    """
    Start a node in a process of its own and return the wall time [s] to its first cloud here.

    :param changes: parameters over those of the file
    :raises ClothSimError: when no cloud comes within ``timeout`` [s]
    """
    rclpy.init()
    listener = rclpy.create_node(f'{_NODE_NAME}_listener')
    seen: list[float] = []
    listener.create_subscription(
        PointCloud2, f'/{_NODE_NAME}/points', lambda _: seen.append(time.perf_counter()),
        _DEPTH)
    log = tempfile.TemporaryFile('w+')
    begin = time.perf_counter()
    process = subprocess.Popen(
        [sys.executable, '-m', 'cloth_sim_ros.node', '--ros-args',
         '-r', f'__node:={_NODE_NAME}', '--params-file', parameter_file,
         *(part for name, value in changes.items()
           for part in ('-p', f'{name}:={json.dumps(value)}'))],
        stdout=log, stderr=log)
    try:
        while not seen and time.perf_counter() - begin < timeout and process.poll() is None:
            rclpy.spin_once(listener, timeout_sec=0.05)
    finally:
        process.terminate()
        process.wait()
        listener.destroy_node()
        rclpy.try_shutdown()
    if not seen:
        log.seek(0)
        raise ClothSimError(
            f'no cloud came from a node with {parameter_file} within {timeout:g} s: it said '
            f'{shown(log.read().strip()[-MOST_SHOWN:])}')
    return seen[0] - begin
