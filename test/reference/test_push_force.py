# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The oracle's pushes: their share of each step, their nodes, their force."""

from cloth_sim_ros.reference.mass_spring import MassSpringReference
from cloth_sim_ros.reference.push_force import push_nodes
from cloth_sim_ros.reference.push_force import push_weight
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

PUSH = Push((0.0, 0.0, 2.0), start=0.05, duration=0.2)


@pytest.mark.parametrize(('begin', 'end', 'weight'), [
    (0.0, 0.05, 0.0), (0.0, 0.1, 0.5), (0.1, 0.2, 1.0), (0.2, 0.3, 0.5), (0.25, 0.3, 0.0),
    (0.0, 0.4, 0.5),
])
def test_weight_is_the_overlap(begin, end, weight):
    """A push counts more or less of a step than it acts in."""
    assert push_weight(PUSH, begin, end) == pytest.approx(weight)


@pytest.mark.parametrize('dt', [0.03, 0.017, 0.2, 0.5])
def test_impulse_is_exact_at_any_dt(dt):
    """The momentum given depends on dt."""
    scene = Scene({
        'rows': 3, 'cols': 4, 'dt': dt, 'auto_substeps': False, 'gravity': [0.0, 0.0, 0.0],
        'pins': ['top_left'],
        **{f'{kind}.{family}': 0.0 for kind in ('stiffness', 'damping')
           for family in ('structural', 'shear', 'bend')}})
    cloth = MassSpringReference(scene)
    cloth.push(PUSH)
    cloth.advance(1.0)
    momentum = scene.node_mass * cloth.velocities.sum(axis=(0, 1))
    np.testing.assert_allclose(momentum, [0.0, 0.0, 0.4], atol=1e-12)
    np.testing.assert_array_equal(cloth.velocities[0, 0], 0.0)


def test_sphere_takes_the_free_nodes_inside():
    """A push in a sphere reaches a pinned node, one outside, or misses one inside."""
    scene = Scene({'rows': 1, 'cols': 5, 'width': 4.0, 'pins': ['0,1'], 'start.z': 0.0})
    push = Push((1.0, 0.0, 0.0), 0.0, 1.0, 'sphere', (-1.0, 0.0, 0.0), 1.5)
    nodes = push_nodes(push, scene.rest_positions(), ~scene.pinned_nodes())
    assert nodes.tolist() == [[True, False, True, False, False]]
