# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The life of the node's process: from the first signal handler to the last file closed."""

from collections.abc import Sequence
import signal

from cloth_sim_ros.node.cloth_sim_node import ClothSimNode
from cloth_sim_ros.node.interfaces import check_interfaces
from cloth_sim_ros.node.refusals import is_about_security
from cloth_sim_ros.node.refusals import no_node
from cloth_sim_ros.node.refusals import ros_reason
from cloth_sim_ros.node.shared_memory import Reclaimed
from cloth_sim_ros.node.shared_memory import SharedMemory
from cloth_sim_ros.sim.errors import ClothSimError
import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.exceptions import NotInitializedException
from rclpy.logging import get_logger_effective_level
from rclpy.logging import LoggingSeverity
from rclpy.logging import set_logger_level


def run_node(
        args: Sequence[str], memory: SharedMemory, reclaimed: Reclaimed) -> None:
    """
    Run the node with the command line ``args`` until it is asked to stop.

    :param memory: what Fast DDS has
    :param reclaimed: what killed processes had left of it
    """
    check_interfaces()
    # rclpy stops the executor on SIGINT by itself. Python's KeyboardInterrupt on top would come
    # at any line, also while the recording is being closed.
    interrupts: list[int] = []
    signal.signal(signal.SIGINT, lambda number, _: interrupts.append(number))
    _init(args)
    try:
        # One that came before rclpy listened is only in the list.
        if not interrupts:
            _spin(memory, reclaimed)
    except (RuntimeError, NotInitializedException):
        # A signal cuts off ROS in the middle of anything, and what is under way then fails.
        if rclpy.ok():
            raise
    finally:
        rclpy.try_shutdown()


def _spin(memory: SharedMemory, reclaimed: Reclaimed) -> None:
    try:
        node = ClothSimNode(memory)
    except RCLError as error:
        # A signal may have shut ROS down meanwhile.
        if not rclpy.ok():
            raise
        raise no_node(error) from error
    try:
        node.begin()
        if reclaimed.segments:
            node.get_logger().info(str(reclaimed))
        node.spin()
    finally:
        try:
            node.close_recording()
        finally:
            node.destroy_node()


def _init(args: Sequence[str]) -> None:
    # rcl would log the same problem once more.
    set_logger_level('rcl', LoggingSeverity.FATAL)
    try:
        rclpy.init(args=list(args))
    except RuntimeError as error:
        if is_about_security(error):
            raise no_node(error) from error
        raise ClothSimError(
            f'the ROS arguments cannot be read: {ros_reason(error)}; give a parameter file with '
            '--ros-args --params-file FILE, one parameter with -p NAME:=VALUE, and write lists '
            'of numbers alike, as in [0.0, 0.0, 1.5]') from error
    # A level given on the command line stays.
    if get_logger_effective_level('rcl') == LoggingSeverity.FATAL:
        set_logger_level('rcl', LoggingSeverity.UNSET)
