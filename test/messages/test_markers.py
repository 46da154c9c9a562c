# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth and what it can touch as markers, already in the bytes that go out."""

from contextlib import closing

from cloth_sim_ros.messages.geometry import strain_colors
from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.mesh import triangles
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cut_scene import CUT
from cut_scene import cut_snapshot
from made_snapshot import make_snapshot
import numpy as np
from pushed_scenes import unit_scene
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


# The markers, decoded.

PUSH = Push.checked(force=(0.0, 0.0, 1.0), start=1.0, duration=0.5)


def decode(data):
    """Return the markers by namespace and number."""
    markers = deserialize_message(data, MarkerArray).markers
    assert len({(marker.ns, marker.id) for marker in markers}) == len(markers)
    return {(marker.ns, marker.id): marker for marker in markers}


def points_of(marker):
    """Return the points of a marker as an array."""
    return np.array([[point.x, point.y, point.z] for point in marker.points])


def test_surface_is_the_cloth():
    """The surface would show other positions or strains than the simulation's."""
    snapshot = make_snapshot(5, 7)
    surface = decode(MarkersMessage(5, 7, 'world').serialise(snapshot))['surface', 0]
    corners = triangles(5, 7).ravel()
    assert (surface.type, surface.action) == (Marker.TRIANGLE_LIST, Marker.ADD)
    assert surface.header.frame_id == 'world'
    assert (surface.header.stamp.sec, surface.header.stamp.nanosec) == (1, 250000000)
    np.testing.assert_array_equal(
        points_of(surface), snapshot.positions.reshape(-1, 3)[corners].astype(float))
    colors = [[color.r, color.g, color.b, color.a] for color in surface.colors]
    np.testing.assert_array_equal(
        np.array(colors, np.float32), strain_colors(snapshot.strain.ravel()[corners]))


@pytest.mark.parametrize(('rows', 'cols'), [(1, 6), (6, 1)])
def test_a_chain_is_a_line(rows, cols):
    """A chain would be invisible."""
    snapshot = make_snapshot(rows, cols)
    chain = decode(MarkersMessage(rows, cols, 'world').serialise(snapshot))['surface', 0]
    assert chain.type == Marker.LINE_STRIP and chain.scale.x > 0.0
    np.testing.assert_array_equal(
        points_of(chain), snapshot.positions.reshape(-1, 3).astype(float))
    assert len(chain.colors) == 6


def test_only_what_is_there_is_sent():
    """Empty markers would cost time and bandwidth, and viewers warn of them."""
    markers = decode(MarkersMessage(5, 7, 'world').serialise(make_snapshot(5, 7)))
    assert list(markers) == [('surface', 0)]


def test_pins_and_active_constraints_stand_on_their_nodes():
    """A pin or a node at its limit would be shown elsewhere."""
    snapshot = make_snapshot(5, 7)
    snapshot.flags[0, 6] = FLAG_PINNED
    snapshot.flags[2, 3] = FLAG_AT_LIMIT
    snapshot.flags[4, 1] = FLAG_PINNED | FLAG_AT_LIMIT
    markers = decode(MarkersMessage(5, 7, 'world').serialise(snapshot))
    pins, limits = markers['pins', 0], markers['active_constraints', 0]
    assert (pins.type, limits.type) == (Marker.SPHERE_LIST, Marker.POINTS)
    np.testing.assert_array_equal(points_of(pins), snapshot.positions[[0, 4], [6, 1]])
    np.testing.assert_array_equal(points_of(limits), snapshot.positions[[2, 4], [3, 1]])


def test_constraints_of_the_adaptive_mode_are_drawn():
    """Nobody would see where the cloth is at its limit."""
    with closing(Simulation(Scene(unit_scene(12, 5.0, 0.01)))) as simulation:
        simulation.advance(0.5)
        snapshot = simulation.snapshot()
    at_limit = (snapshot.flags & FLAG_AT_LIMIT) != 0
    assert 0 < np.count_nonzero(at_limit) < at_limit.size
    markers = decode(MarkersMessage(12, 12, 'world').serialise(snapshot))
    np.testing.assert_array_equal(
        points_of(markers['active_constraints', 0]), snapshot.positions[at_limit])


def test_pushes_are_shown_while_they_act():
    """A push would not be seen, or stay for ever."""
    message = MarkersMessage(5, 7, 'world')
    arrow = decode(message.serialise(make_snapshot(5, 7), [PUSH, PUSH]))['pushes', 1]
    assert (arrow.type, arrow.action, len(arrow.points)) == (Marker.ARROW, Marker.ADD, 2)
    tail, tip = points_of(arrow)
    assert tip[2] > tail[2] and tip[0] == tail[0] and tip[1] == tail[1]
    later = decode(message.serialise(make_snapshot(5, 7, time=1.5), [PUSH, PUSH]))
    assert [later['pushes', number].action for number in (0, 1)] == [Marker.DELETE] * 2


def test_grasps_are_shown_while_they_hold():
    """A gripper would not be seen, or stay where it let go."""
    message = MarkersMessage(5, 7, 'world')
    pose = Pose((0.1, 0.2, 0.3), (0.6, 0.0, 0.0, 0.8))
    grasp = Grasp('hand', pose, np.array([[0, 0]]), 0.0)
    cube = decode(message.serialise(make_snapshot(5, 7), grasps=[grasp]))['grasps', 0]
    place, turn = cube.pose.position, cube.pose.orientation
    assert (place.x, place.y, place.z) == pose.position
    assert (turn.x, turn.y, turn.z, turn.w) == pose.orientation
    assert cube.type == Marker.CUBE and cube.scale.x > 0.0
    later = decode(message.serialise(make_snapshot(5, 7)))
    assert later['grasps', 0].action == Marker.DELETE


def test_what_has_gone_is_deleted_until_it_comes_back():
    """Viewers would keep pins that were released, above all when they missed a message."""
    message = MarkersMessage(4, 4, 'world')
    pinned, free = make_snapshot(4, 4), make_snapshot(4, 4)
    pinned.flags[0, 0] = FLAG_PINNED
    actions = [
        decode(message.serialise(snapshot))['pins', 0].action
        for snapshot in (pinned, free, free, pinned)]
    assert actions == [Marker.ADD, Marker.DELETE, Marker.DELETE, Marker.ADD]


def test_a_large_cloth_stays_a_small_message():
    """A cloth of a million nodes would make messages of 250 MB."""
    data = MarkersMessage(300, 40, 'world', max_side=20).serialise(make_snapshot(300, 40))
    assert len(decode(data)['surface', 0].points) == 6 * 19 * 19


def test_markers_of_a_cut_cloth_are_finite():
    """A marker would be dropped by RViz for a NaN, or have NaN as its scale."""
    scene = Scene(CUT)
    snapshot = cut_snapshot(scene)
    message = MarkersMessage(scene.rows, scene.cols, 'world', present=scene.cut_cells)
    markers = decode(message.serialise(snapshot, [PUSH]))
    surface = points_of(markers['surface', 0])
    assert np.isfinite(surface).all() and len(surface) == 6 * scene.cells.count
    assert np.isfinite(points_of(markers['pushes', 0])).all()
    assert markers['pushes', 0].scale.x == pytest.approx(0.02 * 0.37, rel=0.1)
