# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the topics show, against a simulation without a node on the same device."""

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import Step
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
import numpy as np
import pytest
from sensor_msgs.msg import PointField
from std_srvs.srv import SetBool
from visualization_msgs.msg import Marker


def test_points_are_the_simulation_bit_for_bit(cloth, simulation):
    """The cloud would not show the state that the simulation has at its stamp."""
    assert cloth.call(Step, 'step', steps=37).success
    simulation.step(37)
    assert cloth.frame(37).tobytes() == simulation.snapshot().records.tobytes()


def test_points_follow_pushes_and_pins(cloth, simulation):
    """A push or a pin would have another effect through ROS than without it."""
    assert cloth.call(
        ApplyPush, 'apply_push', force=Vector3(x=0.3, z=0.9), region='sphere',
        center=Point(x=0.05, y=0.05, z=1.0), radius=0.2, duration=0.0421).success
    assert cloth.call(SetPin, 'set_pin', row=7, col=2).success
    assert cloth.call(SetPin, 'set_pin', row=0, col=0, release=True).success
    assert cloth.call(Step, 'step', steps=20).success
    simulation.push(
        (0.3, 0.0, 0.9), region='sphere', center=(0.05, 0.05, 1.0), radius=0.2, duration=0.0421)
    simulation.pin(7, 2)
    simulation.release(0, 0)
    simulation.step(20)
    assert cloth.frame(20).tobytes() == simulation.snapshot().records.tobytes()


def test_running_frames_are_a_fixed_time_apart(cloth, simulation):
    """What a frame simulates would depend on the wall clock, and no run could be repeated."""
    cloth.set_parameters(real_time_factor=0.0)
    assert cloth.call(SetBool, 'pause', data=False).success
    cloth.client.spin_until(lambda: len(cloth['points']) >= 12, 'some frames')
    cloth.call(SetBool, 'pause', data=True)
    frames = {cloth.steps_of(cloud): cloth.points_of(cloud) for cloud in cloth['points'][:12]}
    assert all(steps % 4 == 0 for steps in frames), 'a frame of 20 ms is 4 steps of 5 ms'
    for steps, points in frames.items():
        simulation.step(int(steps) - simulation.steps)
        assert points.tobytes() == simulation.snapshot().records.tobytes()


def test_cloud_is_organised_and_described(cloth):
    """Viewers and PCL would read the wrong numbers, or lose the grid."""
    cloth.call(Step, 'step', steps=1)
    cloud = cloth.wait_for('points')
    assert (cloud.height, cloud.width, cloud.header.frame_id) == (8, 10, 'world')
    assert (cloud.point_step, cloud.row_step) == (44, 440)
    assert cloud.is_dense and not cloud.is_bigendian
    assert [(field.name, field.offset, field.datatype) for field in cloud.fields] == [
        (name, 4 * place, PointField.UINT32 if name == 'flags' else PointField.FLOAT32)
        for place, name in enumerate([
            'x', 'y', 'z', 'vx', 'vy', 'vz', 'normal_x', 'normal_y', 'normal_z', 'strain',
            'flags'])]


def test_stats_are_the_numbers_of_the_snapshot(cloth, simulation):
    """Plots would show other energies than the simulation has."""
    cloth.call(Step, 'step', steps=25)
    stats = cloth.wait_for('stats', lambda message: message.steps == 25)
    simulation.step(25)
    snapshot = simulation.snapshot()
    for name in (
            'dt', 'substeps', 'kinetic_energy', 'elastic_energy', 'gravitational_energy',
            'total_energy', 'max_strain', 'stability_margin'):
        assert getattr(stats, name) == pytest.approx(getattr(snapshot, name), rel=1e-12), name
    assert stats.sim_time == snapshot.time
    assert stats.step_wall_time > 0.0


def test_stats_say_that_the_run_is_slower_than_asked_for(cloth):
    """A controller that streams by the wall clock would not know that its cloth lags behind."""
    assert cloth.set_parameters(real_time_factor=1e6).successful
    assert cloth.call(SetBool, 'pause', data=False).success
    slow = cloth.wait_for('stats', lambda stats: stats.too_slow)
    assert slow.real_time_factor_wanted == 1e6
    assert 0.0 < slow.real_time_factor < 1e6
    assert cloth.set_parameters(real_time_factor=0.0).successful
    cloth.wait_for(
        'stats', lambda stats: stats.real_time_factor_wanted == 0.0 and not stats.too_slow)
    assert cloth.call(SetBool, 'pause', data=True).success
    cloth.clear()
    assert not cloth.wait_for('stats').too_slow


def test_markers_draw_the_cloth(cloth):
    """A viewer would draw another surface than the cloud has."""
    cloth.call(Step, 'step', steps=3)
    points = cloth.frame(3)
    markers = cloth.wait_for('markers', lambda array: cloth.steps_of(array.markers[0]) == 3)
    surface = next(marker for marker in markers.markers if marker.ns == 'surface')
    assert surface.type == Marker.TRIANGLE_LIST
    drawn = {(point.x, point.y, point.z) for point in surface.points}
    nodes = {(float(node['x']), float(node['y']), float(node['z'])) for node in points.flat}
    assert drawn == nodes
    assert len(surface.points) == len(surface.colors) == 2 * 3 * 7 * 9


def test_parameters_turn_topics_off_and_on(cloth):
    """A topic nobody wants would still cost time, or could not be had back."""
    assert cloth.set_parameters(publish__points=False, publish__markers=False).successful
    cloth.clear()
    cloth.call(Step, 'step', steps=2)
    cloth.wait_for('stats', lambda message: message.steps == 2)
    assert not cloth['points'] and not cloth['markers']
    assert cloth.set_parameters(publish__points=True, publish__markers=True).successful
    cloth.call(Step, 'step', steps=2)
    cloth.frame(4)
    cloth.wait_for('markers')


def test_a_paused_cloth_is_shown_again_to_late_viewers(cloth):
    """A viewer started beside a paused node would stay empty."""
    cloth.call(Step, 'step', steps=5)
    first = cloth.frame(5)
    cloth.clear()
    assert np.array_equal(cloth.frame(5), first)
