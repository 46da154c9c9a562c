# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces that hold the pins."""

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.sim.held.pin_forces import edge_pulls
from cloth_sim_ros.sim.held.pin_forces import spring_tension
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import edges_at
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS

SCENE = {
    **SPRINGS,
    'rows': 6, 'cols': 5, 'damping.structural': 0.3, 'damping.shear': 0.2, 'damping.bend': 0.1,
    'adaptive.threshold': 0.1}


def make_state(scene):
    """Return positions and velocities of a crumpled cloth."""
    random = np.random.default_rng(7)
    positions = scene.rest_positions() + random.normal(0.0, 0.05, (scene.rows, scene.cols, 3))
    return positions, random.normal(0.0, 1.0, positions.shape)


def test_tension_is_that_of_a_damped_spring():
    """A tension would be of another spring, or have another sign."""
    scene = Scene(SCENE)
    positions, velocities = make_state(scene)
    tension = spring_tension(scene, positions, velocities)
    assert (tension.shape, tension.dtype) == ((6, 5, 6), np.float32)
    for number, springs in enumerate(spring_sets(scene)):
        first, second = springs.ends(positions)
        along = (second - first) / springs.lengths(positions)[..., None]
        slower, faster = springs.ends(velocities)
        stretch = springs.lengths(positions) - springs.rest_length
        expected = springs.stiffness * stretch + springs.damping * np.sum(
            (faster - slower) * along, axis=-1)
        stored = springs.ends(tension)[0][..., number]
        np.testing.assert_allclose(stored, expected, rtol=1e-5, atol=1e-6)


def test_there_is_none_where_there_is_no_edge():
    """A sum over all entries would count what is not there."""
    scene = Scene({**SPRINGS, **SCENE, 'stiffness.shear': 0.0, 'damping.shear': 0.0})
    tension = spring_tension(scene, *make_state(scene))
    for kind in EDGE_KINDS:
        starts, _ = kind.everywhere(6, 5)
        outside = np.ones((6, 5), dtype=bool)
        outside[starts] = False
        assert not tension[outside, kind.number].any()
        assert tension[(*starts, kind.number)].all() == (kind.family != 'shear')


def test_some_nodes_have_the_tensions_they_have_among_all():
    """The forces at the pins would depend on what else is asked for."""
    scene = Scene(SCENE)
    state = make_state(scene)
    nodes = np.array([(0, 0), (3, 2), (5, 4)])
    every, some = spring_tension(scene, *state), spring_tension(scene, *state, nodes)
    assert np.array_equal(some[some != 0.0], every[some != 0.0])
    edges = edges_at(nodes, 6, 5)
    places = (*edges.starts, edges.kinds)
    assert np.array_equal(some[places], every[places])


def test_a_spring_without_length_is_finite():
    """Two nodes in one place would make all forces at a pin not a number."""
    scene = Scene({**SPRINGS, **SCENE, 'rows': 1, 'cols': 2, 'width': 0.5})
    tension = spring_tension(scene, np.zeros((1, 2, 3)), np.ones((1, 2, 3)))
    assert tension[0, 0, 0] == pytest.approx(-scene.stiffness('structural') * 0.5)


@pytest.mark.parametrize(('rows', 'cols'), [(6, 5), (2, 2), (1, 4), (4, 1)])
def test_edges_pull_as_the_reference_springs(rows, cols):
    """A pin would not feel one of its edges, or feel it the wrong way."""
    scene = Scene({
        **SPRINGS,
        'rows': rows, 'cols': cols, 'damping.shear': 0.2, 'gravity': [1.0, -2.0, -9.81]})
    random = np.random.default_rng(2)
    positions = scene.rest_positions() + random.normal(0.0, 0.05, (rows, cols, 3))
    velocities = random.normal(0.0, 1.0, positions.shape)
    pulls = edges_of(scene).spring_forces(
        positions.reshape(-1, 3), velocities.reshape(-1, 3)).reshape(positions.shape)
    nodes = np.array([(0, 0), (rows // 2, cols - 1), (rows - 1, 0)])
    tension = spring_tension(scene, positions, velocities, nodes)
    found = edge_pulls(scene, positions, velocities, tension, nodes)
    np.testing.assert_allclose(found, pulls[tuple(nodes.T)], rtol=1e-5, atol=1e-5)


def test_nodes_in_one_place_pull_nowhere():
    """The force at a pin would not be a number."""
    scene = Scene({**SPRINGS, 'rows': 1, 'cols': 2})
    assert not edge_pulls(
        scene, np.zeros((1, 2, 3)), None, np.full((1, 2, 6), 5.0), np.array([(0, 0)])).any()


def test_no_nodes_have_no_pulls():
    """A cloth in the air would have no snapshot."""
    scene = Scene({**SPRINGS, 'rows': 2, 'cols': 2})
    pulls = edge_pulls(
        scene, scene.rest_positions(), None, np.zeros((2, 2, 6)), np.empty((0, 2), dtype=int))
    assert pulls.shape == (0, 3)
