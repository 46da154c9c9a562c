# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The size of the cloth is known before there is a node."""

from pathlib import Path

from cloth_sim_ros.node.main import grid_of_arguments
from cloth_sim_ros.node.main import pictures_of_arguments
from cloth_sim_ros.sim.model.given_values import load_parameters
import pytest

SCENES = Path(__file__).resolve().parents[2] / 'config'


@pytest.mark.parametrize('options, grid', [
    ([], (32, 32)),
    (['-p', 'rows:=64'], (64, 32)),
    (['--param', 'cols:=7', '-p', 'rows:=8', '-p', 'rows:=9'], (9, 7)),
    (['-p', 'cloth_sim:rows:=40', '-p', 'dt:=0.01', '-r', '__ns:=/left'], (40, 32)),
    (['-p', 'rows:=many', '-p', 'cols:=-3', '-p', 'rows', '-p', 'cols:=true'], (32, 32)),
    (['-p', 'rows:=[', '-p', 'cols:="', '-p', 'rows:=3.5', '-p'], (32, 32)),
    (['--params-file', 'nowhere.yaml', '-p', 'cols:=5'], (32, 5))], ids=str)
def test_options_are_read(options, grid):
    """The shared memory would be chosen for a cloth of another size."""
    assert grid_of_arguments(['node', '--ros-args', *options]) == grid


@pytest.mark.parametrize('text', [
    '/**: {ros__parameters: {rows: 50, cols: 60, stiffness: {bend: 1.0}}}',
    '/left/cloth_sim: {ros__parameters: {rows: 50, cols: 60}}',
    'left: {cloth_sim: {ros__parameters: {rows: 50, cols: 60}}}',
    '/**: {ros__parameters: {rows: 50, cols: 2}}\nother: {ros__parameters: {rows: 2, cols: 60}}'])
def test_files_are_read(text, tmp_path):
    """The shared memory would be chosen for the default cloth."""
    file = tmp_path / 'scene.yaml'
    file.write_text(text)
    assert grid_of_arguments(['--ros-args', '--params-file', str(file)]) == (50, 60)


@pytest.mark.parametrize('text', ['', '[1, 2]', 'a: &a [*a]', '{', '\x00', 'rows: 4\nrows: ['])
def test_what_cannot_be_read_is_left_to_ros(text, tmp_path):
    """A file with a mistake would end in a traceback and not in the reason that ROS gives."""
    file = tmp_path / 'scene.yaml'
    file.write_text(text)
    assert grid_of_arguments(['--params-file', str(file)]) == (32, 32)


def test_the_scenes_are_read():
    """The scenes that come along would get shared memory for another cloth."""
    files = list(SCENES.glob('*.yaml'))
    for file in files:
        given = {'rows': 32, 'cols': 32, **load_parameters(file)}
        assert grid_of_arguments(['--params-file', str(file)]) == (given['rows'], given['cols'])
    assert len(files) > 2


@pytest.mark.parametrize('options, size', [
    (['-p', 'rows:=64', '-p', 'colliders.names:=[a]', '-p', 'width:=2'], (0, 0)),
    (['-p', 'cameras.names:=[a]'], (640, 480)),
    (['-p', 'cameras.names:=[a, b]', '-p', 'cameras.a.width:=320', '-p', 'cameras.a.height:=240',
      '-p', 'cameras.b.width:=1280'], (1280, 240)),
    (['-p', 'cameras.names:=[a]', '-p', 'cameras.a.width:=wide'], (640, 480))], ids=str)
def test_sizes_of_pictures_are_read(options, size):
    """Best-effort readers of a picture would miss parts of it."""
    assert pictures_of_arguments(['node', '--ros-args', *options]) == size


def test_sizes_of_pictures_are_read_from_files():
    """A scene with a camera would get shared memory for its cloth alone."""
    sizes = {
        name: pictures_of_arguments(['--params-file', str(SCENES / f'{name}.yaml')])
        for name in ('towel_under_camera', 'towel_over_bodies')}
    assert sizes == {'towel_under_camera': (640, 480), 'towel_over_bodies': (0, 0)}
