# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What to do about a Python module that this machine lacks."""

BUILD_COMMAND = (
    'ln -sfn cloth_sim_ros/cloth_sim_interfaces src/cloth_sim_interfaces && colcon build && '
    '. install/setup.bash')


def way_out(error: ImportError) -> str:
    """Return one sentence that says how to get the module; raise ``error`` for an unknown one."""
    package = (error.name or '').partition('.')[0]
    if package == 'cloth_sim_interfaces':
        return (
            'the package cloth_sim_interfaces is not built: in your workspace run '
            f'`{BUILD_COMMAND}`')
    if package == 'tf2_msgs':
        return (
            'the ROS package tf2_msgs is missing: install ros-jazzy-tf2-msgs, or run '
            './scripts/setup.sh again')
    if package in ('rclpy', 'rcl_interfaces', 'std_msgs', 'std_srvs', 'sensor_msgs'):
        return (
            f'ROS 2 was not found ({package} is missing): source /opt/ros/jazzy/setup.bash, or '
            'run ./scripts/setup.sh and then `. .venv/bin/activate`')
    if package in ('rosbags', 'mcap'):
        return (
            f'{package}, which reads and writes recordings, is missing: run `pip install mcap '
            'rosbags`, with --break-system-packages if pip asks for it'
            + (', or source a ROS that has rosbag2_py, which writes them too'
               if package == 'mcap' else ''))
    if package == 'viser':
        return (
            'viser, which shows the cloth in a browser, is missing: run `./scripts/setup.sh '
            '--view`, or `pip install viser`')
    if package == 'gymnasium':
        return 'gymnasium is missing: run `pip install gymnasium`'
    raise error
