# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One frame: the cloth as an organised point cloud, and its plain numbers."""

from dataclasses import replace

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.frame import StatsMessage
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cut_scene import CUT
from cut_scene import cut_snapshot
from made_snapshot import make_snapshot
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2
from sensor_msgs.msg import PointField


def decode(data):
    """Return the message and its points."""
    cloud = deserialize_message(data, PointCloud2)
    points = np.frombuffer(cloud.data, POINT_DTYPE).reshape(cloud.height, cloud.width)
    return cloud, points


@pytest.mark.parametrize(('rows', 'cols'), [(5, 7), (1, 9), (9, 1), (64, 33)])
@pytest.mark.parametrize('frame_id', ['', 'w', 'world', 'map_01', 'großer Rahmen'])
def test_points_are_the_records(rows, cols, frame_id):
    """Positions on the topic would differ from the simulation's."""
    snapshot = make_snapshot(rows, cols)
    snapshot.records['flags'] = np.arange(rows * cols).reshape(rows, cols)
    cloud, points = decode(PointsMessage(rows, cols, frame_id).serialise(snapshot))
    np.testing.assert_array_equal(points, snapshot.records)
    np.testing.assert_array_equal(points['flags'], snapshot.flags)
    assert cloud.header.frame_id == frame_id
    assert (cloud.header.stamp.sec, cloud.header.stamp.nanosec) == (1, 250000000)


def test_layout_is_described():
    """A reader would take the wrong bytes for a coordinate."""
    cloud, _ = decode(PointsMessage(5, 7, 'world').serialise(make_snapshot(5, 7)))
    assert (cloud.height, cloud.width, cloud.point_step, cloud.row_step) == (5, 7, 44, 308)
    assert not cloud.is_bigendian and cloud.is_dense
    names = ['x', 'y', 'z', 'vx', 'vy', 'vz', 'normal_x', 'normal_y', 'normal_z', 'strain']
    assert [field.name for field in cloud.fields] == [*names, 'flags']
    assert [field.offset for field in cloud.fields] == list(range(0, 44, 4))
    assert [field.datatype for field in cloud.fields] == (
        [PointField.FLOAT32] * 10 + [PointField.UINT32])
    assert all(field.count == 1 for field in cloud.fields)


def test_each_message_is_its_own():
    """A message that waits to be sent would change with the next frame."""
    message = PointsMessage(4, 4, 'world')
    first = make_snapshot(4, 4)
    second = make_snapshot(4, 4, time=2.000000001, records=np.zeros_like(first.records))
    data = message.serialise(first)
    other, points = decode(message.serialise(second))
    np.testing.assert_array_equal(points, second.records)
    assert (other.header.stamp.sec, other.header.stamp.nanosec) == (2, 1)
    cloud, points = decode(data)
    np.testing.assert_array_equal(points, first.records)
    assert cloud.header.stamp.nanosec == 250000000


def test_takes_records_that_are_not_contiguous():
    """A view of a larger array would be sent with the wrong nodes."""
    snapshot = make_snapshot(6, 8)
    part = replace(snapshot, records=snapshot.records[::2, 1:5])
    _, points = decode(PointsMessage(3, 4, 'world').serialise(part))
    np.testing.assert_array_equal(points, snapshot.records[::2, 1:5])


def test_a_state_that_is_not_finite_is_not_dense():
    """A reader would trust points that are not numbers."""
    message = PointsMessage(2, 2, 'world')
    assert not decode(message.serialise(make_snapshot(2, 2, finite=False)))[0].is_dense
    assert decode(message.serialise(make_snapshot(2, 2)))[0].is_dense


def test_another_grid_is_refused():
    """The cloud would claim a size its bytes don't have."""
    with pytest.raises(ValueError, match='create a PointsMessage for this cloth'):
        PointsMessage(3, 4, 'world').serialise(make_snapshot(4, 3))


# One frame in plain numbers.

NUMBERS = {
    'solver_iterations': 11, 'solver_residual': 1e-3, 'solver_reached': False,
    'active_constraints': 12,
    'active_fraction': 0.25, 'constraint_switches': 13, 'calm_substeps': 15,
    'listed_substeps': 16, 'whole_substeps': 17, 'listed_edges': 18, 'limit_rounds': 19,
    'limit_unreached': 20, 'strain_bound': 0.05, 'settling': True,
    'settling_work': 0.75, 'stalled_pins': 14, 'air_margin': 2.5}


def test_every_number_is_in_its_place():
    """A plot would show one number under the name of another."""
    snapshot = make_snapshot(2, 2, **NUMBERS)
    message = stats_message(
        snapshot, 'world', step_wall_time=0.125, real_time_factor=0.75, wanted_factor=1.5,
        too_slow=True)
    stats = deserialize_message(serialize_message(message), type(message))
    assert stats.header.frame_id == 'world'
    assert (stats.header.stamp.sec, stats.header.stamp.nanosec) == (1, 250000000)
    assert stats.sim_time == snapshot.time
    assert (stats.step_wall_time, stats.real_time_factor) == (0.125, 0.75)
    assert (stats.real_time_factor_wanted, stats.too_slow) == (1.5, True)
    own = {
        'header', 'sim_time', 'step_wall_time', 'real_time_factor', 'real_time_factor_wanted',
        'too_slow'}
    names = set(stats.get_fields_and_field_types()) - own
    assert {name: getattr(stats, name) for name in names} == {
        name: getattr(snapshot, name) for name in names}


@pytest.mark.parametrize('value', [float('nan'), float('inf')])
def test_a_run_that_blew_up_is_still_told(value):
    """The node would stop on the first number that is not finite."""
    stats = stats_message(make_snapshot(2, 2, kinetic_energy=value, finite=False), 'world')
    assert str(stats.kinetic_energy) == str(value)


@pytest.mark.parametrize('frame_id', ['', 'w', 'world', 'map_01', 'großer Rahmen'])
def test_serialised_statistics_are_those_of_the_message(frame_id):
    """A field would be read in the place of another."""
    snapshot = make_snapshot(
        2, 2, time=3.000000007, steps=2**40, solver_reached=False, solver_iterations=7,
        stalled_pins=3, deepest_node=0.25, max_strain=float('inf'))
    pace = {'step_wall_time': 1e-3, 'real_time_factor': 0.9, 'wanted_factor': 1.0,
            'too_slow': True}
    data = StatsMessage(frame_id).serialise(snapshot, **pace)
    assert deserialize_message(data, ClothStats) == stats_message(snapshot, frame_id, **pace)


def test_a_cloud_of_a_cut_cloth_is_organised():
    """A filter would take the places without a node for points at the origin."""
    scene = Scene(CUT)
    snapshot = cut_snapshot(scene)
    cloud, points = decode(PointsMessage(
        scene.rows, scene.cols, 'world', is_dense=not scene.has_gaps).serialise(snapshot))
    assert (cloud.height, cloud.width, cloud.is_dense) == (scene.rows, scene.cols, False)
    for name in ('x', 'vy', 'normal_z', 'strain'):
        np.testing.assert_array_equal(np.isnan(points[name]), ~scene.present_nodes)
