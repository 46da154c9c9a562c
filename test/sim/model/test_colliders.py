# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Colliders of a scene: what is accepted."""

from body_distance import distance_to
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.collider_surface import collider_surface
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS

BALL = {'colliders.names': ['ball'], 'colliders.ball.size': [0.1]}


@pytest.mark.parametrize(('values', 'rule'), [
    ({'colliders.names': ['Ball']}, 'lower-case letters'),
    ({'colliders.names': ['names']}, 'lower-case letters'),
    ({'colliders.names': ['a', 'a'], 'colliders.a.size': [1.0]}, 'a name twice'),
    ({'colliders.names': ['ball']}, 'colliders.ball.size needs 1 for a sphere, got 0'),
    ({**BALL, 'colliders.ball.size': [-1.0]}, 'outside its range'),
    ({**BALL, 'colliders.ball.friction': float('nan')}, 'must be finite'),
    ({**BALL, 'colliders.ball.orientation': [0.0, 0.0, 0.0, 0.0]}, 'no direction'),
    ({**BALL, 'colliders.ball.position': [0.0]}, 'needs 3 numbers, got 1'),
    ({**BALL, 'colliders.ball.shape': 'plane'}, 'a plane has none'),
    ({**BALL, 'colliders.bowl.size': [1.0]}, 'list bowl in colliders.names'),
    ({**BALL, 'layout': 'paper'}, 'layout paper has no contact'),
    ({**BALL, 'adaptive.scheme': 'paper'}, 'adaptive.scheme paper has no contact'),
    ({**BALL, 'collider_moves.start': [0.0], 'collider_moves.name': ['bowl'],
      'collider_moves.target': [0.0, 0.0, 0.0], 'collider_moves.speed': [1.0]},
     'not one of colliders.names'),
    ({**BALL, 'collider_moves.start': [0.0], 'collider_moves.name': ['ball'],
      'collider_moves.target': [0.0, 0.0, 0.0], 'collider_moves.orientation': [0.0] * 4},
     'has no direction')])
def test_bad_values_are_refused(values, rule):
    """A scene would run with another body than the one its author meant."""
    with pytest.raises(ClothSimError, match=rule):
        Scene(values)


def test_orientations_are_made_unit_quaternions():
    """A body would be stretched by a quaternion of another length."""
    scene = Scene({**SPRINGS, **BALL, 'colliders.ball.orientation': [0.0, 0.0, 2.0, 2.0]})
    axes = scene.colliders[0].axes
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    # A quarter turn about z takes x to y.
    np.testing.assert_allclose(axes[0], [0.0, 1.0, 0.0], atol=1e-12)


@pytest.mark.parametrize(('shape', 'size'), [
    ('plane', []), ('sphere', [0.3]), ('capsule', [0.2, 0.5]), ('box', [0.3, 0.5, 0.7]),
    ('cylinder', [0.3, 0.5])])
def test_distances(shape, size):
    """The report of the deepest node would be wrong."""
    body = Scene({
        **SPRINGS,
        'colliders.names': ['body'], 'colliders.body.shape': shape, 'colliders.body.size': size,
        'colliders.body.position': [0.1, -0.2, 0.3],
        'colliders.body.orientation': [0.3, -0.2, 0.5, 0.7]}).colliders[0]
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (20, 30, 3))
    np.testing.assert_allclose(body.distance(points), distance_to(body, points), atol=1e-12)


@pytest.mark.parametrize(('shape', 'size', 'core'), [
    ('sphere', [0.3], (0.0, 0.0, 0.0)), ('capsule', [0.1, 0.5], (0.0, 0.0, 0.25)),
    ('capsule', [0.2, 0.5], (0.0, 0.0, 0.0)), ('cylinder', [0.1, 0.5], (0.0, 0.0, 0.25)),
    ('cylinder', [0.3, 0.1], (0.0, 0.0, 0.0)), ('box', [0.9, 0.2, 0.3], (0.45, 0.0, 0.0))])
def test_a_body_is_near_its_core(shape, size, core):
    """Nodes that come to the end of a long body would pass it."""
    body = Scene({
        **SPRINGS, 'colliders.names': ['body'], 'colliders.body.shape': shape,
        'colliders.body.size': size}).colliders[0]
    assert body.core == pytest.approx(core)
    points, _ = collider_surface(body, reach=1.0)
    axis = np.array(body.core)
    along = points @ axis / max(axis @ axis, 1e-30)
    away = np.linalg.norm(points - np.clip(along, -1.0, 1.0)[..., None] * axis, axis=-1)
    assert away.max() == pytest.approx(body.reach_from_core, rel=1e-2)
    assert away.max() <= body.reach_from_core + 1e-12
