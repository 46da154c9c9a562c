# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The launch file, by the launch system of ROS where that is installed."""

from importlib.util import module_from_spec
from importlib.util import spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
# Wheels of ROS have no launch system; a sourced ROS has.
pytest.importorskip('launch_ros')


def simulator(params_file: str, **arguments: str) -> list:
    """Return the nodes that the launch file starts with ``params_file``."""
    from launch import LaunchContext
    spec = spec_from_file_location('cloth_sim_launch', ROOT / 'launch' / 'cloth_sim.launch.py')
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    context = LaunchContext()
    context.launch_configurations.update(
        params_file=params_file, mode='', recording='', namespace='', rviz='false', **arguments)
    return module.simulator(context)


@pytest.mark.parametrize('params_file', ['nofile.yaml', '', str(ROOT)])
def test_a_parameter_file_that_is_none_is_refused(params_file: str):
    """Another cloth than the one asked for would be started, with a warning."""
    with pytest.raises(RuntimeError, match='is not a file: give the path of a ROS parameter'):
        simulator(params_file)


def test_a_parameter_file_is_given_to_the_node():
    """The node would not start, or with its defaults."""
    assert len(simulator(str(ROOT / 'config' / 'towel.yaml'))) == 1
