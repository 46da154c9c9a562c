# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Put a cloth into the system of another simulator: its /clock, and a place in its tf tree.

    ros2 launch cloth_sim_ros beside_simulator.launch.py parent:=table x:=0.4 z:=0.02

An example to copy: it includes cloth_sim.launch.py as any launch file can.
"""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

PACKAGE = FindPackageShare('cloth_sim_ros')


def generate_launch_description() -> LaunchDescription:
    """Describe the cloth, and where it is in the tf tree."""
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', default_value=PathJoinSubstitution([PACKAGE, 'config', 'towel.yaml']),
            description='ROS parameter file of the scene'),
        DeclareLaunchArgument('namespace', default_value='cloth', description='of the node'),
        DeclareLaunchArgument(
            'parent', default_value='world', description='frame that the cloth is placed in'),
        *(DeclareLaunchArgument(axis, default_value='0.0', description=f'{axis} in it [m]')
          for axis in 'xyz'),
        DeclareLaunchArgument(
            'time', default_value='ros', choices=['own', 'ros', 'wall'],
            description='ros beside a simulator, wall beside a real robot'),
        DeclareLaunchArgument(
            'recording', default_value='false', choices=['true', 'false'],
            description='record from the start'),
        Node(
            package='tf2_ros', executable='static_transform_publisher', name='cloth_place',
            namespace=LaunchConfiguration('namespace'), arguments=[
                *(part for axis in 'xyz' for part in (f'--{axis}', LaunchConfiguration(axis))),
                '--frame-id', LaunchConfiguration('parent'), '--child-frame-id', 'cloth']),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(
                PathJoinSubstitution([PACKAGE, 'launch', 'cloth_sim.launch.py'])),
            launch_arguments={
                'params_file': LaunchConfiguration('params_file'),
                'namespace': LaunchConfiguration('namespace'), 'frame_id': 'cloth',
                'time': LaunchConfiguration('time'),
                'recording': LaunchConfiguration('recording')}.items()),
    ])
