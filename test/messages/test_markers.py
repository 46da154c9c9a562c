# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The markers, decoded."""

from contextlib import closing

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.messages.markers import push_arrows
from cloth_sim_ros.messages.markers import put_marker
from cloth_sim_ros.messages.surface import strain_colors
from cloth_sim_ros.messages.surface import triangles
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Vector3
from made_snapshot import make_snapshot
import numpy as np
from pushed_scenes import unit_scene
import pytest
from rclpy.serialization import deserialize_message
from std_msgs.msg import ColorRGBA
from std_msgs.msg import Header
from visualization_msgs.msg import Marker
from visualization_msgs.msg import MarkerArray

NODES = np.array([[0.0, 0.0, 1.0], [2.0, 4.0, 1.0]])
PUSH = Push.checked(force=(0.0, 0.0, 1.0), start=1.0, duration=0.5)


@pytest.mark.parametrize('frame_id', ['', 'a', 'ab', 'abc', 'abcd', 'world'])
@pytest.mark.parametrize('count', [0, 1, 3])
def test_every_field_is_read_back(frame_id, count):
    """Markers of some frame names or sizes would be read from the wrong place."""
    points = np.arange(3.0 * count).reshape(count, 3)
    colors = np.linspace(0.0, 1.0, 4 * count, dtype=np.float32).reshape(count, 4)
    writer = CdrWriter()
    writer.put('I', 2)
    for number in (5, 6):
        put_marker(
            writer, time=Time(sec=7, nanosec=8), frame_id=frame_id, namespace='pins',
            number=number, kind=Marker.POINTS, scale=(0.5, 0.25, 0.125),
            color=(0.0, 0.25, 0.5, 1.0), points=points, colors=colors)
    expected = [
        Marker(
            header=Header(stamp=Time(sec=7, nanosec=8), frame_id=frame_id), ns='pins', id=number,
            type=Marker.POINTS, action=Marker.ADD, pose=Pose(),
            scale=Vector3(x=0.5, y=0.25, z=0.125), color=ColorRGBA(g=0.25, b=0.5, a=1.0),
            points=[Point(x=x, y=y, z=z) for x, y, z in points.tolist()],
            colors=[ColorRGBA(r=r, g=g, b=b, a=a) for r, g, b, a in colors.tolist()])
        for number in (5, 6)]
    assert deserialize_message(writer.finish(), MarkerArray).markers == expected


def test_only_pushes_that_act_are_shown():
    """A push would show before it begins or after it ends."""
    push = Push.checked(force=(0.0, 0.0, 2.0), start=1.0, duration=0.5)
    shown = [len(push_arrows([push], time, NODES, 1.0)) for time in (0.99, 1.0, 1.49, 1.5)]
    assert shown == [0, 1, 1, 0]


def test_arrows_stand_in_their_region_and_point_along_the_force():
    """A push would show somewhere else, in another direction or strength."""
    everywhere = Push.checked(force=(0.0, 0.0, -4.0), start=0.0, duration=1.0)
    sphere = Push.checked(
        force=(2.0, 0.0, 0.0), start=0.0, duration=1.0, region='sphere',
        center=(5.0, 6.0, 7.0), radius=0.1)
    first, second = push_arrows([everywhere, sphere], 0.5, NODES, 0.3)
    np.testing.assert_allclose(first, [[1.0, 2.0, 1.0], [1.0, 2.0, 0.7]])
    np.testing.assert_allclose(second, [[5.0, 6.0, 7.0], [5.15, 6.0, 7.0]])


def test_a_push_without_force_has_no_arrow():
    """The arrow of a zero force would have a direction that is not a number."""
    push = Push.checked(force=(0.0, 0.0, 0.0), start=0.0, duration=1.0)
    assert push_arrows([push], 0.5, NODES, 1.0) == []


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
