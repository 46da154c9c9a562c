# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Build the two packages the ordinary ROS way, and use what was installed."""

import os
from pathlib import Path
import shlex
import subprocess

from catkin_pkg.package import parse_package
from catkin_pkg.packages import find_packages
from cloth_sim_ros.node.missing_module import BUILD_COMMAND
import pytest

ROOT = Path(__file__).resolve().parents[1]
NOT_SOURCES = {'.git', '.venv', 'build', 'install', 'log', 'bags'}


def bash(command: str, folder: Path) -> str:
    """Run a command as the README says, after scripts/env.sh; return what it printed."""
    done = subprocess.run(
        ['bash', '-ec', f'. {shlex.quote(str(ROOT))}/scripts/env.sh; {command}'],
        cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def build(base: Path, *arguments: str) -> Path:
    """Build at the root of the checkout with the defaults that lie there."""
    bash(
        f'colcon --log-base {base}/log build --build-base {base}/build '
        f'--install-base {base}/install {" ".join(arguments)}', ROOT)
    return base / 'install'


def colcon_test(base: Path, *arguments: str) -> str:
    """Run tests with what ``build`` has built into ``base``; return what was printed."""
    return bash(
        f'. {base}/install/setup.bash; colcon --log-base {base}/log test --packages-ignore '
        f'cloth_sim_interfaces --build-base {base}/build --install-base {base}/install '
        f'--return-code-on-test-failure --pytest-args {" ".join(arguments)} 1>&2; '
        f'colcon test-result --test-result-base {base}/build --verbose', ROOT)


@pytest.fixture(scope='module')
def installed(tmp_path_factory) -> Path:
    """Build the package over the messages that the set-up has built with the same cmake files."""
    return build(tmp_path_factory.mktemp('colcon'), '--packages-ignore', 'cloth_sim_interfaces')


def test_both_packages_are_found():
    """A `colcon build` at the root would miss the interface package."""
    assert {line.split()[0] for line in bash('colcon list', ROOT).splitlines()} == {
        'cloth_sim_interfaces', 'cloth_sim_ros'}


@pytest.mark.long
def test_both_packages_are_built(tmp_path):
    """An installed node would need the messages of the checkout's own set-up."""
    installed = build(tmp_path)
    for package in ('cloth_sim_ros', 'cloth_sim_interfaces'):
        index = installed / package / 'share' / 'ament_index' / 'resource_index' / 'packages'
        assert (index / package).is_file()
    printed = bash(
        f'. {installed}/setup.bash; python3 -c "'
        'import cloth_sim_interfaces.srv; print(cloth_sim_interfaces.__file__)"', tmp_path)
    assert Path(printed.strip()).is_relative_to(installed)


def test_colcon_test_finds_the_tests(installed):
    """`colcon test` would be green without having run a test."""
    printed = colcon_test(installed.parent, 'test/test_lint.py', '-k', 'versions_agree')
    assert 'Summary: 1 test, 0 errors, 0 failures, 0 skipped' in printed


@pytest.mark.parametrize('name', ['cloth_sim', 'cloth_sim_node'])
def test_executables_are_where_ros2_run_looks(installed, name):
    """`ros2 run cloth_sim_ros ...` would not find the executable."""
    path = installed / 'cloth_sim_ros' / 'lib' / 'cloth_sim_ros' / name
    assert os.access(path, os.X_OK)


@pytest.mark.parametrize('folder', ['config', 'launch', 'shaders'])
def test_every_shared_file_is_installed(installed, folder):
    """An installed node would lack shaders, a scene or its launch file."""
    share = installed / 'cloth_sim_ros' / 'share' / 'cloth_sim_ros'
    sources = [path for path in (ROOT / folder).rglob('*')
               if path.is_file() and '__pycache__' not in path.parts]
    assert sources
    for path in sources:
        copy = share / path.relative_to(ROOT)
        assert copy.read_bytes() == path.read_bytes()


def test_installed_code_runs_without_the_checkout(installed, tmp_path):
    """The installed node would need the source tree beside it."""
    printed = bash(
        f'. {installed}/setup.bash; python3 -c "'
        'import cloth_sim_ros.node.process as process; '
        'import cloth_sim_ros.gl.shared_directory as shaders; '
        'print(process.__file__, shaders.shader_directory())"',
        tmp_path)
    for place in printed.split():
        assert Path(place).is_relative_to(installed)


def test_files_of_the_package_are_installed(installed):
    """An installed `cloth_sim paper table10` would lack the printed rates, or the C source."""
    for source in (ROOT / 'cloth_sim_ros' / 'study' / 'paper').glob('*.[!p]*'):
        copy, = (installed / 'cloth_sim_ros').rglob(f'cloth_sim_ros/study/paper/{source.name}')
        assert copy.read_bytes() == source.read_bytes()


def test_workspace_build(installed, tmp_path):
    """The command that README and node tell to someone with a workspace would not work."""
    checkout = tmp_path / 'src' / 'cloth_sim_ros'
    checkout.mkdir(parents=True)
    for path in ROOT.iterdir():
        if path.name not in NOT_SOURCES:
            (checkout / path.name).symlink_to(path)
    command = f'. {installed}/setup.bash; {BUILD_COMMAND}'
    printed = bash(
        command.replace('colcon build', 'colcon build --packages-ignore cloth_sim_interfaces')
        + ' && python3 -c "import cloth_sim_ros.node as node; print(node.__file__)"', tmp_path)
    assert Path(printed.split()[-1]).is_relative_to(tmp_path / 'install')
    listed = bash('colcon list', tmp_path)
    assert sorted(line.split()[0] for line in listed.splitlines()) == [
        'cloth_sim_interfaces', 'cloth_sim_ros']
    # What rosdep finds them by.
    assert {package.name for package in find_packages(str(tmp_path / 'src')).values()} == {
        'cloth_sim_interfaces', 'cloth_sim_ros'}


def test_a_workspace_needs_no_viewer():
    """A machine without a display, such as a robot, would have to install one."""
    depends = parse_package(str(ROOT / 'package.xml')).exec_depends
    assert 'rclpy' in {each.name for each in depends}
    assert not {each.name for each in depends} & {'rviz2', 'simulation_interfaces'}
