# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is said about modules that are not there."""

from cloth_sim_ros.node.missing_module import way_out
import pytest


def test_says_how_to_build_the_interfaces():
    """A user without the interface package would not learn the one command."""
    text = way_out(ModuleNotFoundError(name='cloth_sim_interfaces.msg'))
    assert 'src/cloth_sim_interfaces && colcon build' in text
    assert 'cloth_sim_interfaces' in text


def test_says_where_ros_comes_from():
    """A user without ROS would not learn how to get it."""
    assert '/opt/ros/jazzy/setup.bash' in way_out(ModuleNotFoundError(name='rclpy'))


def test_says_what_a_small_ros_lacks():
    """A user whose ROS has no tf2 would get a traceback."""
    assert 'ros-jazzy-tf2-msgs' in way_out(ModuleNotFoundError(name='tf2_msgs'))


def test_says_what_environments_need():
    """A user who measures environments would get a traceback."""
    assert 'pip install gymnasium' in way_out(ModuleNotFoundError(name='gymnasium'))


def test_does_not_guess():
    """Another missing module would be taken for a missing ROS."""
    with pytest.raises(ModuleNotFoundError):
        way_out(ModuleNotFoundError(name='cloth_sim_ros.typo'))


@pytest.mark.parametrize('name', ['mcap.writer', 'rosbags'])
def test_says_what_reads_and_writes_recordings(name):
    """A user who did not install the pip packages would get a traceback."""
    text = way_out(ModuleNotFoundError(name=name))
    assert text.startswith(name.partition('.')[0])
    assert 'pip install mcap rosbags' in text
    assert '--break-system-packages' in text
