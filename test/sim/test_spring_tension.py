# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The tension of springs, from the state alone."""

from cloth_sim_ros.reference.springs import spring_sets
from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.spring_tension import spring_tension
import numpy as np
import pytest

SCENE = {
    'rows': 6, 'cols': 5, 'damping.structural': 0.3, 'damping.shear': 0.2, 'damping.bend': 0.1,
    'adaptive.threshold': 0.1}


def make_state(scene):
    """Return positions and velocities of a crumpled cloth."""
    random = np.random.default_rng(7)
    positions = scene.rest_positions() + random.normal(0.0, 0.05, (scene.rows, scene.cols, 3))
    return positions, random.normal(0.0, 1.0, positions.shape)


def test_tension_is_the_force_of_the_reference_along_the_spring():
    """A tension would be of another spring, or have another sign."""
    scene = Scene(SCENE)
    positions, velocities = make_state(scene)
    tension = spring_tension(scene, positions, velocities)
    assert (tension.shape, tension.dtype) == ((6, 5, 6), np.float32)
    for number, springs in enumerate(spring_sets(scene)):
        force = springs.forces(positions, velocities)
        first, second = springs.ends(positions)
        along = (second - first) / springs.lengths(positions)[..., None]
        stored = springs.ends(tension)[0][..., number]
        np.testing.assert_allclose(stored, np.sum(force * along, axis=-1), rtol=1e-5, atol=1e-6)


def test_there_is_none_where_there_is_no_edge():
    """A sum over all entries would count what is not there."""
    scene = Scene({**SCENE, 'stiffness.shear': 0.0, 'damping.shear': 0.0})
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
    for kind in EDGE_KINDS:
        starts, _ = kind.touching(nodes, 6, 5)
        assert np.array_equal(some[(*starts, kind.number)], every[(*starts, kind.number)])


def test_a_spring_without_length_is_finite():
    """Two nodes in one place would make all forces at a pin not a number."""
    scene = Scene({**SCENE, 'rows': 1, 'cols': 2, 'width': 0.5})
    tension = spring_tension(scene, np.zeros((1, 2, 3)), np.ones((1, 2, 3)))
    assert tension[0, 0, 0] == pytest.approx(-scene.stiffness('structural') * 0.5)
