# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""J of the flat list of edges against finite differences, and the families in it."""

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.sim.scene import Scene
import numpy as np


def _scene(**values):
    return Scene({'rows': 4, 'cols': 5, 'width': 1.3, 'height': 0.9, 'damping.shear': 0.03,
                  'stiffness.shear': 70.0, **values})


def test_jacobian_is_the_slope_of_the_lengths():
    """J v is not the rate at which the edges grow."""
    scene = _scene()
    random = np.random.default_rng(2)
    positions = (scene.rest_positions() + random.normal(0.0, 0.05, (4, 5, 3))).reshape(-1, 3)
    moved = random.normal(0.0, 1.0, positions.shape)
    edges = edges_of(scene)
    slope = (edges.lengths(positions + 1e-6 * moved)
             - edges.lengths(positions - 1e-6 * moved)) / 2e-6
    jacobian = edges.jacobian(edges.directions(positions), len(positions))
    np.testing.assert_allclose(jacobian @ moved.ravel(), slope, atol=1e-8)


def test_families_that_are_always_there():
    """A cloth without springs has no edges to hold."""
    scene = _scene(**{
        f'{kind}.{family}': 0.0 for kind in ('stiffness', 'damping')
        for family in ('structural', 'shear', 'bend')})
    assert len(edges_of(scene)) == 0
    assert set(edges_of(scene, always=('structural', 'shear')).family) == {
        'structural', 'shear'}
