# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Markers of colliders: viewers show the bodies that the cloth touches, where it touches them."""

from contextlib import closing

from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from springs import SPRINGS
from visualization_msgs.msg import Marker
from visualization_msgs.msg import MarkerArray

QUARTER = [0.0, 0.70710678, 0.0, 0.70710678]


def markers_of(values, seconds=0.0):
    """Return the markers of the colliders of a scene, by namespace and number."""
    scene = Scene({**SPRINGS, 'rows': 3, 'cols': 3, **values})
    with closing(Simulation(scene)) as simulation:
        if seconds:
            simulation.advance(seconds)
        data = MarkersMessage(3, 3, 'world').serialise(
            simulation.snapshot(), colliders=simulation.colliders)
    return {
        (marker.ns, marker.id): marker for marker in deserialize_message(data, MarkerArray).markers
        if marker.ns.startswith('collider/')}


def vector(value):
    """Return a point or a scale as an array."""
    return np.array([value.x, value.y, value.z])


@pytest.mark.parametrize(('shape', 'size', 'kind', 'scale'), [
    ('sphere', [0.2], Marker.SPHERE, [0.4, 0.4, 0.4]),
    ('box', [0.1, 0.2, 0.3], Marker.CUBE, [0.1, 0.2, 0.3]),
    ('cylinder', [0.2, 0.5], Marker.CYLINDER, [0.4, 0.4, 0.5])])
def test_a_body_is_shown_as_large_as_it_is(shape, size, kind, scale):
    """The cloth would be seen to hover above a body, or to pass through it."""
    marker, = markers_of({
        'colliders.names': ['body'], 'colliders.body.shape': shape, 'colliders.body.size': size,
        'colliders.body.position': [1.0, 2.0, -3.0],
        'colliders.body.orientation': QUARTER}).values()
    assert (marker.type, marker.ns) == (kind, 'collider/body')
    np.testing.assert_allclose(vector(marker.scale), scale)
    np.testing.assert_allclose(vector(marker.pose.position), [1.0, 2.0, -3.0])
    turn = marker.pose.orientation
    np.testing.assert_allclose([turn.x, turn.y, turn.z, turn.w], QUARTER, atol=1e-7)


def test_a_capsule_has_round_ends():
    """A capsule would be shown as a cylinder, and end too early."""
    found = markers_of({
        'colliders.names': ['body'], 'colliders.body.shape': 'capsule',
        'colliders.body.size': [0.1, 0.6], 'colliders.body.orientation': QUARTER})
    assert [marker.type for marker in found.values()] == [
        Marker.CYLINDER, Marker.SPHERE, Marker.SPHERE]
    # A quarter turn about y takes its axis z to x.
    ends = [vector(found['collider/body', number].pose.position) for number in (1, 2)]
    np.testing.assert_allclose(ends, [[-0.3, 0.0, 0.0], [0.3, 0.0, 0.0]], atol=1e-7)


def test_the_upper_side_of_a_plane_is_where_the_cloth_lies():
    """A cloth on the floor would be hidden by it."""
    marker, = markers_of({'colliders.names': ['floor'], 'colliders.floor.shape': 'plane'}).values()
    assert marker.pose.position.z + marker.scale.z / 2.0 == pytest.approx(0.0)


def test_a_moving_body_is_shown_where_it_is():
    """A body would be seen where it was at the start."""
    marker, = markers_of({
        'colliders.names': ['ball'], 'colliders.ball.size': [0.1],
        'colliders.ball.position': [5.0, 0.0, 0.0], 'collider_moves.start': [0.0],
        'collider_moves.name': ['ball'], 'collider_moves.target': [5.0, 0.0, 1.0],
        'collider_moves.speed': [2.0]}, seconds=0.1).values()
    np.testing.assert_allclose(vector(marker.pose.position), [5.0, 0.0, 0.2], atol=1e-9)
