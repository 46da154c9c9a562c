# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The values given for a scene: read from a file, and completed by preset and fabric."""

from pathlib import Path

from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.materials import FABRICS
from cloth_sim_ros.sim.model.scene_fields import PRESETS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
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


# Presets say how to step, and leave what is given alone.

# Parameters that a preset may set: of the time stepping, not of the cloth.
_STEPPING = {
    'mode', 'dt', 'auto_substeps', 'refine', 'substeps', 'constraint.hard', 'constraint.springs',
    'constraint.newton_iterations', 'solver.tolerance'}


def values_of(preset):
    """Return what the file of a preset sets."""
    return load_parameters(shared_directory('config') / 'presets' / f'{preset}.yaml')


@pytest.mark.parametrize('preset', PRESETS)
def test_it_sets_what_is_left_out(preset):
    """A preset would do nothing, or change the cloth itself."""
    values = values_of(preset)
    assert values and set(values) <= _STEPPING
    scene = Scene({'preset': preset, 'rows': 5})
    assert {name: scene[name] for name in values} == {
        name: tuple(value) if isinstance(value, list) else value
        for name, value in values.items()}
    # All that stays cloth: hard edges would make another one of it.
    assert scene['mode'] == 'mass_spring' or scene['constraint.hard'] == ()


@pytest.mark.parametrize('preset', PRESETS)
def test_what_is_given_wins(preset):
    """A user's own dt would be lost."""
    given = {'preset': preset, 'dt': 0.003, 'refine': 7, 'mode': 'adaptive'}
    scene = Scene(given)
    assert {name: scene[name] for name in given} == given
    assert Scene(scene.values).values == scene.values


@pytest.mark.parametrize('preset', PRESETS)
@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_given_mode_keeps_its_edges_with_a_preset(preset, mode):
    """A preset of implicit springs would make the hard edges of the given mode elastic."""
    scene, without = Scene({'preset': preset, 'mode': mode}), Scene({'mode': mode})
    for name in ('mode', 'constraint.hard', 'constraint.springs'):
        assert scene[name] == without[name]


def test_none_is_the_default():
    """A scene would be stepped in another way than its parameters say."""
    assert Scene()['preset'] == 'none'
    assert Scene({'preset': 'none'}).values == Scene().values


def test_an_unknown_one_is_refused():
    """A mistyped preset would be passed over in silence."""
    with pytest.raises(ClothSimError, match='fast, balanced, accurate'):
        Scene({'preset': 'quick'})


@pytest.mark.parametrize('preset', PRESETS)
def test_its_file_tells_where_it_comes_from(preset):
    """A user could not tell on what a preset was measured."""
    text = (shared_directory('config') / 'presets' / f'{preset}.yaml').read_text()
    for name in ('For ', 'device: ', 'version: ', 'scene sha256: ', 'budget-', 'error: '):
        assert f'# {name}' in text, name


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_refine_multiplies_the_substeps(context, mode):
    """Presets that differ in it would be the same."""
    counts = []
    for refine in (1, 3):
        simulation = Simulation(Scene({
            'mode': mode, 'rows': 12, 'cols': 9, 'dt': 0.01, 'refine': refine}), context=context)
        simulation.step()
        counts.append(simulation.substeps)
        simulation.close()
    assert counts[1] == 3 * counts[0]


def test_default_fabric():
    """The first cloth of a user would stretch like rubber, or whip without air."""
    fabric = FABRICS['trousers']
    scene = Scene({'rows': 12, 'damping.shear': 0.02})
    assert scene['material.preset'] == 'trousers' and scene['air.density'] == 1.225
    assert {name: scene[name] for name in ('areal_density', 'material.warp')} == {
        'areal_density': fabric.density, 'material.warp': fabric.warp}
    assert scene['bending.rigidity'] == fabric.rigidity
    assert not scene.models('bend')
    assert Scene(scene.values).values == scene.values


@pytest.mark.parametrize('given', [
    {'stiffness.shear': 50.0}, {'material.preset': 'none'}, {'material.warp': 50.0},
    {'material.preset': 'denim'}, {'rows': 1}, {'cols': 1}], ids=str)
def test_what_says_how_it_stretches_takes_its_place(given):
    """A scene of springs or of another fabric would get air that it does not ask for."""
    scene = Scene(given)
    assert scene['air.density'] == 0.0
    assert scene['material.preset'] == given.get('material.preset', 'none')
    assert scene.has_rigidity == (given.get('material.preset') == 'denim')


def test_what_is_given_of_the_default_fabric_wins():
    """A user could not take the air away, or weigh a cloth."""
    scene = Scene({'air.density': 0.0, 'areal_density': 0.1})
    assert (scene['air.density'], scene['areal_density']) == (0.0, 0.1)
    assert scene['material.preset'] == 'trousers'
