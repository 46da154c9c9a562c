# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a ROS package keeps its files."""

import os

from cloth_sim_ros.recording.message_definition import share_folder
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


@pytest.mark.parametrize('package', ['sensor_msgs', 'cloth_sim_interfaces'])
@pytest.mark.parametrize('path', [None, os.devnull])
def test_definitions_are_found_with_and_without_an_index(monkeypatch, package, path):
    """A recording would fail in an environment where the node itself runs."""
    if path is not None:
        monkeypatch.setenv('AMENT_PREFIX_PATH', path)
    assert any((share_folder(package) / 'msg').glob('*.msg'))


def test_a_missing_package_is_told():
    """The node would end with a traceback instead of saying what to install."""
    with pytest.raises(ClothSimError, match='no_such_package has no share folder'):
        share_folder('no_such_package')
