# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Parameter files are read as ROS reads them."""

from pathlib import Path

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene_file import load_parameters
import pytest


def test_nested_and_dotted_names_are_one(tmp_path: Path):
    """The same file would mean something else to the node and to `cloth_sim run`."""
    path = tmp_path / 'scene.yaml'
    path.write_text(
        '/**:\n  ros__parameters:\n    stiffness:\n      shear: 2.0\n'
        '    stiffness.bend: 3.0\n    pins: [top_edge]\n'
        'cloth_sim:\n  ros__parameters:\n    dt: 0.01\n')
    assert load_parameters(path) == {
        'stiffness.shear': 2.0, 'stiffness.bend': 3.0, 'pins': ['top_edge'], 'dt': 0.01}


@pytest.mark.parametrize(('text', 'message'), [
    ('rows: 3\n', 'has a section without ros__parameters'),
    ('', 'holds no parameters'),
    ('a: [1, 2\n', 'is not valid YAML'),
    ('- 1\n', 'holds no parameters'),
])
def test_files_that_are_no_parameter_files(tmp_path: Path, text: str, message: str):
    """The user would get a traceback, or a scene of defaults."""
    path = tmp_path / 'scene.yaml'
    path.write_text(text)
    with pytest.raises(ClothSimError, match=message):
        load_parameters(path)


def test_a_missing_file_is_named(tmp_path: Path):
    """The user would get a traceback for a misspelt path."""
    with pytest.raises(ClothSimError, match=r'nothing\.yaml cannot be read'):
        load_parameters(tmp_path / 'nothing.yaml')


@pytest.mark.parametrize(('text', 'rule'), [
    ('    dt: 0.01\n    dt: 0.02\n', 'the key dt twice'),
    ('    stiffness.bend: 1.0\n    stiffness: {bend: 2.0}\n', 'stiffness.bend twice')])
def test_a_parameter_that_stands_twice_is_refused(tmp_path: Path, text: str, rule: str):
    """One of two values would be taken without a word."""
    path = tmp_path / 'scene.yaml'
    path.write_text(f'/**:\n  ros__parameters:\n{text}')
    with pytest.raises(ClothSimError, match=rule):
        load_parameters(path)
