# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Start the cloth simulator, and RViz when asked for.

    ros2 launch cloth_sim_ros cloth_sim.launch.py params_file:=my_cloth.yaml rviz:=true
"""

from launch import LaunchContext
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.actions import OpaqueFunction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

AS_IN_FILE = ''


def shipped(name: str) -> PathJoinSubstitution:
    """Return the path of a file in the package's config folder."""
    return PathJoinSubstitution([FindPackageShare('cloth_sim_ros'), 'config', name])


def simulator(context: LaunchContext) -> list[Node]:
    """Return the node; an argument that was not given leaves the params file its say."""
    given = {}
    mode = LaunchConfiguration('mode').perform(context)
    if mode != AS_IN_FILE:
        given['mode'] = mode
    recording = LaunchConfiguration('recording').perform(context)
    if recording != AS_IN_FILE:
        given['recording.enabled'] = recording == 'true'
    return [Node(
        package='cloth_sim_ros',
        executable='cloth_sim_node',
        name='cloth_sim',
        namespace=LaunchConfiguration('namespace'),
        output='screen',
        parameters=[LaunchConfiguration('params_file')] + ([given] if given else []),
    )]


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments, the node and RViz."""
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', default_value=shipped('drape.yaml'),
            description='parameters of the scene and the node, as ROS parameter YAML'),
        DeclareLaunchArgument(
            'mode', default_value=AS_IN_FILE,
            description='how the cloth is advanced; without it, as params_file says'),
        DeclareLaunchArgument(
            'recording', default_value=AS_IN_FILE, choices=[AS_IN_FILE, 'true', 'false'],
            description='record from the start; without it, as params_file says'),
        DeclareLaunchArgument(
            'rviz', default_value='false', choices=['true', 'false'],
            description='show the cloth in RViz'),
        DeclareLaunchArgument(
            'namespace', default_value='', description='namespace of the node'),
        OpaqueFunction(function=simulator),
        Node(
            condition=IfCondition(LaunchConfiguration('rviz')),
            package='rviz2',
            executable='rviz2',
            arguments=['--display-config', shipped('cloth_sim.rviz')],
        ),
    ])
