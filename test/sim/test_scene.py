# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A scene is what its parameters say, or is refused whole."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model import grid
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

_MOVE = {'pin_moves.start': [1.0], 'pin_moves.node': ['0,0'], 'pin_moves.target': [0.0, 0.0, 1.0]}


@pytest.mark.parametrize('fabric', ['none', 'trousers'])
def test_the_nodes_weigh_what_the_cloth_does(fabric: str):
    """The cloth would weigh something else than its areal density says."""
    scene = Scene({
        'rows': 4, 'cols': 5, 'width': 2.0, 'height': 3.0, 'areal_density': 0.5,
        'material.preset': fabric})
    assert scene.mass == pytest.approx(0.5 * 6.0)
    assert scene.node_mass * scene.node_shares.sum() == pytest.approx(0.5 * 6.0)
    assert scene.mass_per_area == pytest.approx(0.5)
    assert Scene({'node_mass': 0.7}).node_mass == 0.7


def test_nodes_of_springs_have_equal_masses():
    """Scenes that give springs, or the mass of a node, would be no longer those of the paper."""
    for values in ({'material.preset': 'none'}, {'stiffness.structural': 10.0},
                   {'node_mass': 0.1}, {'layout': 'paper'}, {'rows': 1}):
        scene = Scene({'rows': 4, 'cols': 5, 'air.density': 0.0, **values})
        assert scene.cells is None and np.all(scene.node_shares == 1.0)
        assert scene.mass == pytest.approx(scene.node_mass * scene.node_count)


def test_the_cloth_weighs_its_total_mass():
    """A towel of 0.3 kg would have the mass of the default areal density times its area."""
    scene = Scene({'rows': 7, 'cols': 9, 'width': 0.5, 'height': 0.9, 'total_mass': 0.3})
    assert scene.mass == pytest.approx(0.3)
    # A finer lattice of the same cloth weighs as much.
    finer = Scene({**scene.values, 'rows': 13, 'cols': 17})
    assert finer.node_mass * finer.node_shares.sum() == pytest.approx(0.3)


@pytest.mark.parametrize(('others', 'named'), [
    ({'areal_density': 0.25}, 'total_mass 0.3 and areal_density 0.25'),
    ({'node_mass': 0.01}, 'total_mass 0.3 and node_mass 0.01'),
    ({'node_mass': 0.01, 'areal_density': 0.25},
     'total_mass 0.3 and node_mass 0.01 and areal_density 0.25')])
def test_one_parameter_alone_says_what_the_cloth_weighs(others: dict, named: str):
    """One of two weights would be passed over without a word."""
    with pytest.raises(ClothSimError) as caught:
        Scene({'total_mass': 0.3, **others})
    assert str(caught.value) == (
        f'{named} each set the mass of the cloth: give one of them, and set the others to 0')
    assert Scene({'total_mass': 0.3, **dict.fromkeys(others, 0.0)})['total_mass'] == 0.3


def test_a_cloth_without_mass_is_refused():
    """Forces would be divided by 0."""
    with pytest.raises(ClothSimError, match=r'no mass, as areal_density is 0: give total_mass'):
        Scene({'areal_density': 0.0})


@pytest.mark.parametrize('pose', ['horizontal', 'hanging'])
def test_pins_stand_at_their_points(pose: str):
    """A pin that is given in metres would hold another node than the one at that place."""
    values = {'rows': 5, 'cols': 9, 'width': 0.8, 'height': 0.4, 'start.pose': pose,
              'start.z': 0.7}
    rest = Scene(values).rest_positions()
    points = [*(rest[1, 2] + 0.02), *(rest[4, 8] - 0.03)]
    pinned = Scene({**values, 'pin_points.positions': points}).pinned_nodes()
    assert np.argwhere(pinned).tolist() == [[1, 2], [4, 8]]
    both = Scene({**values, 'pins': ['top_left'], 'pin_points.positions': points})
    assert np.argwhere(both.pinned_nodes()).tolist() == [[0, 0], [1, 2], [4, 8]]


@pytest.mark.parametrize(('values', 'message'), [
    ({'pin_points.positions': [0.0, 0.5]}, 'pin_points.positions needs 3 numbers per point, got 2 '
     'in all'),
    ({'pin_points.positions': [0.0, 0.5, 1.3]},
     'no node is within 0.25 m of the point (0, 0.5, 1.3): the nearest, (0, 2), is 0.3 m away; '
     'give a point nearer to it, or a larger pin_points.max_distance'),
    ({'pin_points.positions': [0.0, 0.5, 1.02], 'pin_points.max_distance': 0.01},
     'no node is within 0.01 m of the point (0, 0.5, 1.02)'),
])
def test_a_point_off_the_cloth_pins_nothing(values: dict, message: str):
    """A point in other units, or of another pose, would pin some node far from it."""
    with pytest.raises(ClothSimError) as caught:
        Scene({'rows': 5, 'cols': 5, **values})
    assert message in str(caught.value)


def test_a_scene_is_the_same_made_from_its_own_values():
    """A recording or a study would run another cloth than the scene that it was given."""
    scene = Scene({'rows': 5, 'cols': 5, 'total_mass': 0.3,
                   'pin_points.positions': [0.0, 0.5, 1.0]})
    again = Scene(scene.values)
    assert again.values == scene.values
    assert again.node_mass == scene.node_mass
    assert np.array_equal(again.pinned_nodes(), scene.pinned_nodes())


def test_the_lattice_has_the_size_asked_for():
    """Rest lengths would not fit width and height."""
    scene = Scene({'rows': 4, 'cols': 5, 'width': 2.0, 'height': 3.0, 'start.z': 1.5})
    positions = scene.rest_positions()
    assert positions.shape == (4, 5, 3)
    np.testing.assert_allclose(positions[0, 0], [-1.0, 1.5, 1.5])
    np.testing.assert_allclose(positions[3, 4], [1.0, -1.5, 1.5])
    np.testing.assert_allclose(scene.spacing, (0.5, 1.0))


def test_a_hanging_cloth_has_row_0_on_top():
    """Pins of the top edge would hold the bottom."""
    positions = Scene({'start.pose': 'hanging', 'start.z': 1.0}).rest_positions()
    assert np.all(np.diff(positions[:, 0, 2]) < 0.0)
    assert np.all(positions[..., 1] == 0.0)
    assert positions[..., 2].mean() == pytest.approx(1.0)


def test_jitter_moves_free_nodes_only_and_repeats():
    """A pinned corner would start elsewhere, or the same scene differ from run to run."""
    values = {'start.jitter': 0.1, 'start.seed': 5, 'rows': 6, 'cols': 7}
    first, second = Scene(values), Scene(values)
    offsets = first.start_positions() - first.rest_positions()
    assert np.array_equal(first.start_positions(), second.start_positions())
    assert np.all(offsets[first.pinned_nodes()] == 0.0)
    assert 0.0 < np.abs(offsets).max() <= 0.1 * min(first.spacing)


def test_an_unknown_name_is_refused_with_the_nearest():
    """A misspelt parameter would be ignored, and the user wonder why nothing changes."""
    with pytest.raises(ClothSimError, match=r'no parameter stiffnes\.shear: did you mean '
                                            r'stiffness\.shear\?'):
        Scene({'stiffnes.shear': 1.0})


@pytest.mark.parametrize(('name', 'hint'), [
    ('stiffness', 'did you mean stiffness.structural, stiffness.shear or stiffness.bend?'),
    ('dampng', 'did you mean damping.structural, damping.shear or damping.bend?'),
    ('stiffness.structual', 'did you mean stiffness.structural?'),
    ('pin', 'did you mean pins?'), ('start_pose', 'did you mean start.pose?'),
    ('thickness', 'did you mean contact.thickness or self_contact.thickness?'),
    ('wind', 'did you mean air.wind or gusts.wind?'),
    ('holes', 'did you mean shape.holes?'),
    ('viscosity', 'docs/reference/parameters.md lists them all')])
def test_the_name_of_a_group_gets_its_members(name: str, hint: str):
    """A user who sets one stiffness for all would be led to that of the bend springs."""
    with pytest.raises(ClothSimError) as caught:
        Scene({name: 500.0})
    assert str(caught.value) == f'there is no parameter {name}: {hint}'


@pytest.mark.parametrize(('values', 'message'), [
    ({'rows': 1, 'cols': 1}, 'a cloth needs 2 nodes or more'),
    ({'gravity': [0.0, -9.81]}, 'gravity needs 3 components, got 2'),
    ({'pins': ['left']}, "pins has 'left': give none, all"),
    ({'pins': ['40,0']}, r'there is no node (40, 0) in a cloth of 32 x 32 nodes'),
    ({'mode': 'rigid'}, "mode must be one of mass_spring, constraint, adaptive, got 'rigid'"),
    ({'pushes.start': [1.0]}, 'pushes.duration needs 1 per push, 1 for the 1 in pushes.start'),
    ({'pushes.start': [1.0], 'pushes.duration': [0.1], 'pushes.force': [1.0, 2.0]},
     'pushes.force needs 3 per push, 3 for the 1'),
    ({'pushes.start': [1.0], 'pushes.duration': [0.0], 'pushes.force': [1.0, 2.0, 3.0]},
     'the duration of a push must be above 0 and at most'),
    ({'air.wind': [1.0, 2.0]}, 'air.wind needs 3 components, got 2'),
    ({'air.density': 1.225, 'rows': 1}, 'a chain of rows 1 x cols 32 has none: give 2 or more'),
    ({'gusts.start': [1.0]}, 'gusts.duration needs 1 per gust, 1 for the 1 in gusts.start'),
    ({'gusts.start': [1.0], 'gusts.duration': [0.5], 'gusts.wind': [1.0]},
     'gusts.wind needs 3 per gust, 3 for the 1'),
    ({'air.density': -1.0}, 'air.density -1.0 is outside its range: give a value from 0 to 10000'),
    ({'air.wind': [0.0, 0.0, 2000.0]}, 'give a value from -1000 to 1000 m/s'),
    ({'air.drag': float('nan')}, 'air.drag must be finite'),
    ({'pin_moves.start': [1.0]}, 'node needs 1 per move, 1 for the 1 in pin_moves.start'),
    ({'pin_moves.node': ['0,0']}, 'pin_moves.node needs 1 per move, 0 for the 0'),
    ({**_MOVE, 'pin_moves.target': [1.0, 2.0]}, 'pin_moves.target needs 3 per move, 3 for the 1'),
    ({**_MOVE, 'pin_moves.speed': [1.0, 2.0]}, 'pin_moves.speed needs 1 per move, 1 for the 1'),
    ({**_MOVE, 'pin_moves.node': ['left']}, "pin_moves.node has 'left': give none, all"),
    ({**_MOVE, 'pin_moves.node': ['top_edge']}, "node has 'top_edge', which is 32 nodes"),
    ({**_MOVE, 'pin_moves.node': ['3,4']},
     "pin_moves.node has '3,4', which is not pinned: add it to pins"),
])
def test_what_does_not_fit_together_is_refused(values: dict, message: str):
    """A scene that can't be meant would start and do something else."""
    with pytest.raises(ClothSimError) as caught:
        Scene(values)
    assert message in str(caught.value)


def test_timed_pushes_are_read_one_by_one():
    """Forces of several pushes would be mixed up."""
    scene = Scene({
        'pushes.start': [1.0, 2.0], 'pushes.duration': [0.1, 0.2],
        'pushes.force': [1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 'pushes.radius': [0.0, 0.3],
        'pushes.center': [0.0, 0.0, 0.0, 7.0, 8.0, 9.0]})
    first, second = scene.timed_pushes()
    assert (first.region, first.force, first.end) == ('all', (1.0, 2.0, 3.0), 1.1)
    assert (second.region, second.center, second.radius) == ('sphere', (7.0, 8.0, 9.0), 0.3)


def test_timed_moves_are_read_one_by_one():
    """Targets of several moves would be mixed up, or a pin go at another's speed."""
    scene = Scene({
        'rows': 5, 'cols': 7, 'pins': ['top_right', '2,3'], 'pin_speed': 0.25,
        'pin_moves.start': [1.0, 0.5], 'pin_moves.node': ['2,3', 'top_right'],
        'pin_moves.target': [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]})
    first, second = scene.timed_pin_moves()
    assert (first.node, first.target, first.speed, first.start) == (
        (2, 3), (1.0, 2.0, 3.0), 0.25, 1.0)
    assert (second.node, second.target, second.speed, second.start) == (
        (0, 6), (4.0, 5.0, 6.0), 0.25, 0.5)
    fast = Scene({**scene.values, 'pin_moves.speed': [1.0, 2.0]})
    assert [move.speed for move in fast.timed_pin_moves()] == [1.0, 2.0]


def test_a_large_scene_is_read_without_laying_it_out(monkeypatch):
    """A refusal of too many nodes would take seconds, and gigabytes."""
    def refuse(*_: object) -> None:
        raise AssertionError('nodes are laid out')

    monkeypatch.setattr(grid, 'rest_positions', refuse)
    scene = Scene({'rows': 8192, 'cols': 8192})
    assert scene.pinned_nodes().sum() > 0
    with pytest.raises(AssertionError, match='laid out'):
        Scene({'rows': 8, 'cols': 8, 'pin_points.positions': [0.0, 0.0, 1.0]}).pinned_nodes()
