# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Start the cloth simulator, and RViz when asked for.

    ros2 launch cloth_sim_ros cloth_sim.launch.py params_file:=my_cloth.yaml rviz:=true
"""

import os
import shutil

from ament_index_python.packages import get_package_prefix
from ament_index_python.packages import PackageNotFoundError
from launch import LaunchContext
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.actions import OpaqueFunction
from launch.actions import Shutdown
from launch.substitutions import LaunchConfiguration
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

AS_IN_FILE = ''

# What a larger system sets, as parameters of the node.
SYSTEM = {
    'frame_id': lambda value: {'frame_id': value},
    'time': lambda value: {
        'time.source': 'ros' if value == 'ros' else 'own',
        'time.epoch': 'wall' if value == 'wall' else 'zero'},
    'simulation_interfaces': lambda value: {'simulation_interfaces': value == 'true'}}

# What config/cloth_sim.rviz shows, by the names that a node without a namespace has.
RVIZ_TOPICS = ('/cloth_sim/markers', '/cloth_sim/points', '/cloth_sim/pins/wrenches')
# A click belongs to the cloth of its namespace.
CLICKS = ('/clicked_point', 'clicked_point')


def shipped(name: str) -> PathJoinSubstitution:
    """Return the path of a file in the package's config folder."""
    return PathJoinSubstitution([FindPackageShare('cloth_sim_ros'), 'config', name])


def end_with_launch() -> list[str]:
    """
    Return a prefix that sends SIGINT to the node when launch itself was killed.

    After SIGTERM or SIGKILL, launch leaves its processes behind; a recording would never end.
    """
    return ['setpriv --pdeathsig INT --'] if shutil.which('setpriv') else []


def simulator(context: LaunchContext) -> list[Node]:
    """Return the node; an argument that was not given leaves the params file its say."""
    params_file = LaunchConfiguration('params_file').perform(context)
    # Launch passes on what is no file as a warning, and the node would start with its defaults.
    if not os.path.isfile(params_file):
        raise RuntimeError(
            f'params_file:={params_file} is not a file: give the path of a ROS parameter file, '
            f'absolute or from {os.getcwd()}')
    given = {}
    mode = LaunchConfiguration('mode').perform(context)
    if mode != AS_IN_FILE:
        given['mode'] = mode
    recording = LaunchConfiguration('recording').perform(context)
    if recording != AS_IN_FILE:
        given['recording.enabled'] = recording == 'true'
    for argument, parameters in SYSTEM.items():
        value = LaunchConfiguration(argument, default=AS_IN_FILE).perform(context)
        if value != AS_IN_FILE:
            given |= parameters(value)
    return [Node(
        package='cloth_sim_ros',
        executable='cloth_sim_node',
        exec_name='cloth_sim_node',
        name='cloth_sim',
        namespace=LaunchConfiguration('namespace'),
        output='screen',
        parameters=[params_file] + ([given] if given else []),
        remappings=[CLICKS],
        prefix=[LaunchConfiguration('launch-prefix', default=''), ' ', *end_with_launch()],
        on_exit=Shutdown(reason='the simulator has ended'),
    )]


def rviz(context: LaunchContext) -> list[Node]:
    """Return RViz when it is asked for; it shows the node of the same namespace."""
    if LaunchConfiguration('rviz').perform(context) != 'true':
        return []
    try:
        get_package_prefix('rviz2')
    except PackageNotFoundError as error:
        raise RuntimeError(
            'rviz:=true needs the package rviz2, which is not here: run `apt install '
            f'ros-{os.environ.get("ROS_DISTRO", "jazzy")}-rviz2`, or leave rviz:=true out'
        ) from error
    return [Node(
        package='rviz2',
        executable='rviz2',
        namespace=LaunchConfiguration('namespace'),
        arguments=['--display-config', shipped('cloth_sim.rviz')],
        remappings=[CLICKS, *((name, name.lstrip('/')) for name in RVIZ_TOPICS)],
    )]


def generate_launch_description() -> LaunchDescription:
    """Describe the arguments, the node and RViz."""
    return LaunchDescription([
        DeclareLaunchArgument(
            'params_file', default_value=shipped('drape.yaml'),
            description='ROS parameter file of the scene and the node'),
        DeclareLaunchArgument(
            'mode', default_value=AS_IN_FILE,
            description='simulation mode (default: as in params_file)'),
        DeclareLaunchArgument(
            'recording', default_value=AS_IN_FILE, choices=[AS_IN_FILE, 'true', 'false'],
            description='start recording at launch (default: as in params_file)'),
        DeclareLaunchArgument(
            'rviz', default_value='false', choices=['true', 'false'],
            description='start RViz with a view of the cloth'),
        DeclareLaunchArgument(
            'namespace', default_value='', description='namespace of the node and of RViz'),
        DeclareLaunchArgument(
            'frame_id', default_value=AS_IN_FILE,
            description='frame of the cloth in the tf tree of the system (default: as in '
            'params_file)'),
        DeclareLaunchArgument(
            'time', default_value=AS_IN_FILE, choices=[AS_IN_FILE, 'own', 'ros', 'wall'],
            description='stamps and pace: own, begin at 0; ros, follow /clock; wall, those of the '
            'wall clock (default: as in params_file)'),
        DeclareLaunchArgument(
            'simulation_interfaces', default_value=AS_IN_FILE,
            choices=[AS_IN_FILE, 'true', 'false'],
            description='serve simulation_interfaces (default: as in params_file)'),
        # The actions below take these two by their names.
        DeclareLaunchArgument(
            'sigterm_timeout', default_value='30',
            description='seconds between SIGINT, which closes the recording, and SIGTERM'),
        DeclareLaunchArgument(
            'sigkill_timeout', default_value='60',
            description='seconds between SIGTERM and SIGKILL, which truncates the recording'),
        # First, so that nothing has been started when it is missing.
        OpaqueFunction(function=rviz),
        OpaqueFunction(function=simulator),
    ])
