# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a frame is made of: the cloud, markers, plain numbers, pins and bodies of one moment."""

from pathlib import Path

from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_under_test import ClothUnderTest
from cloth_under_test import PAUSED
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Quaternion
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import WrenchStamped
from made_again import made_again
from node_process import NodeProcess
import numpy as np
from PIL import Image
import pytest
from recorded import Recorded
from sensor_msgs.msg import PointField
from std_srvs.srv import SetBool
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker

KEY = 'pins/wrenches'
PIN = 'node_tests_cloth_sim_pin_{}_{}'


def frames_of(messages):
    """Return parent and place of each child frame."""
    frames = {}
    for message in messages:
        for frame in message.transforms:
            place, turn = frame.transform.translation, frame.transform.rotation
            assert (turn.x, turn.y, turn.z, turn.w) == (0.0, 0.0, 0.0, 1.0)
            frames[frame.child_frame_id] = (frame.header.frame_id, (place.x, place.y, place.z))
    return frames


def forces_of(messages):
    """Return the force of each message by its frame."""
    vectors = {message.header.frame_id: message.wrench.force for message in messages}
    return {frame: (force.x, force.y, force.z) for frame, force in vectors.items()}


def wait_for_wrenches(cloth, *, steps, count):
    """Return the wrenches after ``steps`` steps, when ``count`` have come."""
    def of_then():
        return [message for message in cloth[KEY] if cloth.steps_of(message) == steps]

    cloth.client.spin_until(lambda: len(of_then()) >= count, f'{count} wrenches')
    return of_then()


def expected_forces(forces):
    """Return the force that each holder of a frame feels, by its frame."""
    return {
        PIN.format(row, col): tuple(force)
        for (row, col), force in zip(forces.pins.nodes.tolist(), forces.pins.forces.tolist())}


def test_each_holder_feels_its_pin(cloth, simulation):
    """A gripper would read another force than it holds with, or one of another time."""
    assert cloth.call(SetPin, 'set_pin', row=3, col=4).success
    assert cloth.call(Step, 'step', steps=20).success
    window = simulation.open_force_window()
    simulation.pin(3, 4)
    simulation.step(20)
    told = forces_of(wait_for_wrenches(cloth, steps=20, count=3))
    assert set(told) == {PIN.format(0, 0), PIN.format(0, 9), PIN.format(3, 4)}
    assert told == expected_forces(simulation.frame_forces(window))


def test_every_wrench_has_its_frame(cloth, simulation):
    """A viewer could not draw a wrench, for want of a transform, or would draw it elsewhere."""
    assert cloth.call(
        MovePin, 'move_pin', row=0, col=9, target=Point(x=0.5, y=0.3, z=1.2), speed=1.0).success
    # Other steps than in the test before, of which a wrench can still be under way.
    assert cloth.call(Step, 'step', steps=24).success
    told = cloth.wait_for('tf', lambda message: cloth.steps_of(message.transforms[0]) == 24)
    assert {cloth.steps_of(frame) for frame in told.transforms} == {24}
    simulation.move_pin(0, 9, (0.5, 0.3, 1.2), 1.0)
    simulation.step(24)
    positions = simulation.snapshot().positions
    assert frames_of([told]) == {
        PIN.format(row, col): ('world', tuple(positions[row, col].tolist()))
        for row, col in ((0, 0), (0, 9))}
    wrenches = wait_for_wrenches(cloth, steps=24, count=2)
    assert {message.header.frame_id for message in wrenches} == set(frames_of([told]))


def test_a_recording_has_them(cloth):
    """What a robot would have felt could not be looked up afterwards."""
    path = Path(cloth.call(StartRecording, 'start_recording', name='').path)
    assert cloth.call(Step, 'step', steps=8).success
    assert cloth.call(Trigger, 'stop_recording').success
    recorded = Recorded(path).messages(KEY)
    assert [cloth.steps_of(message) for message in recorded] == [0, 0, 8, 8]
    published = wait_for_wrenches(cloth, steps=8, count=2)
    assert forces_of(recorded[2:]) == forces_of(published)
    places = [message for topic, _, message in Recorded(path).entries if topic == '/tf']
    assert [cloth.steps_of(message.transforms[0]) for message in places] == [0, 8]
    assert set(frames_of(places[1:])) == set(forces_of(recorded[2:]))


@pytest.mark.parametrize('is_published', [False, True])
def test_clock_is_recorded_where_it_is_published(tmp_path, client, is_published):
    """Whoever played the recording moved the time of every node with use_sim_time."""
    values = {**PAUSED, 'publish.clock': is_published}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/clocked'):
        cloth = ClothUnderTest(client, values, '/clocked/cloth_sim')
        path = Path(cloth.call(
            StartRecording, 'start_recording', name=f'clock_{is_published}').path)
        assert cloth.call(Step, 'step', steps=4).success
        assert cloth.call(Trigger, 'stop_recording').success
        topics = {topic.name for topic in BagReader(path).topics if topic.count}
    assert ('/clock' in topics) == is_published
    assert '/clocked/cloth_sim/stats' in topics


def test_the_parameter_turns_them_off_and_on(cloth):
    """A topic nobody wants would still cost time, or could not be had back."""
    assert cloth.set_parameters(publish__wrenches=False, publish__tf=False).successful
    assert cloth.call(Step, 'step', steps=2).success
    cloth.frame(2)
    # A paused node shows each second where it is: both come then from here on, for step 2 as well.
    cloth.client.spin_for(0.2)
    assert all(cloth.steps_of(message) != 2 for message in cloth[KEY])
    assert all(cloth.steps_of(message.transforms[0]) != 2 for message in cloth['tf'])
    assert cloth.set_parameters(publish__wrenches=True, publish__tf=True).successful
    assert cloth.call(Step, 'step', steps=2).success
    cloth.wait_for(KEY, lambda message: cloth.steps_of(message) == 4)
    cloth.wait_for('tf', lambda message: cloth.steps_of(message.transforms[0]) == 4)


def test_too_many_pins_are_told_and_not_sent(client, tmp_path):
    """A cloth that is pinned all over would bring its node to a stand, or be silent unasked."""
    scene = {**PAUSED, 'rows': 33, 'cols': 33, 'pins': ['all']}
    with NodeProcess(tmp_path, scene, '-r', '__ns:=/many_pins') as node:
        watch = client.watch(WrenchStamped, '/many_pins/cloth_sim/pins/wrenches')
        frames = client.watch(TFMessage, '/tf')
        client.spin_until(lambda: 'so neither is published' in node.output, 'the warning')
        assert not watch.messages
        assert not any(
            frame.startswith('many_pins') for frame in frames_of(frames.messages))
    assert node.output.count('so neither is published') == 1


# Frames and wrenches of grasps and colliders, against a simulation on the same device.

FRAME = 'handled_cloth_sim_{}'


def at_step(cloth, key, steps):
    """Return the messages of that step, when there are any."""
    cloth.client.spin_until(
        lambda: any(cloth.steps_of(message) == steps for message in cloth[key]), key)
    cloth.client.spin_until_quiet()
    return {
        message.header.frame_id: message.wrench for message in cloth[key]
        if cloth.steps_of(message) == steps}


def parts(vector):
    """Return the components of a message as an array."""
    return np.array([vector.x, vector.y, vector.z])


def test_bodies_feel_the_cloth_in_their_own_frames(handled, twin):
    """A sensor in a hand would read in other axes, about another point, or another time."""
    orientation = Quaternion(x=0.0, y=0.6, z=0.0, w=0.8)
    here = Pose(position=Point(x=-0.5, y=-0.3, z=1.0), orientation=orientation)
    assert handled.call(Grasp, 'grasp', name='hand', pose=here, radius=0.2).success
    twin.grasp('hand', (-0.5, -0.3, 1.0), (0.0, 0.6, 0.0, 0.8), radius=0.2)
    # The node adds forces up once it knows their readers: a frame before that has none.
    keys, steps = ('grasps/peak_wrenches', 'grasps/wrenches', 'colliders/wrenches'), 0
    while not all(any(handled.steps_of(message) == steps for message in handled[key])
                  for key in keys) or steps == 0:
        assert handled.call(Step, 'step', steps=1).success
        twin.step(1)
        steps += 1
        assert steps < 100, 'no forces'
        handled.client.spin_for(0.2)
    window = twin.open_force_window()
    to = Pose(position=Point(x=0.0, y=0.0, z=1.0), orientation=orientation)
    assert handled.call(MoveFrame, 'move_collider', name='ball', pose=to).success
    twin.move_collider('ball', (0.0, 0.0, 1.0), (0.0, 0.6, 0.0, 0.8))
    assert handled.call(Step, 'step', steps=60).success
    twin.step(60)
    forces = twin.frame_forces(window)
    (felt,), (grasp,) = forces.grasps, twin.grasps
    peak = at_step(handled, 'grasps/peak_wrenches', steps + 60)[FRAME.format('grasp_hand')]
    np.testing.assert_array_equal(parts(peak.force), grasp.pose.axes @ felt.peak)
    assert not parts(peak.torque).any()
    wrench = at_step(handled, 'grasps/wrenches', steps + 60)[FRAME.format('grasp_hand')]
    np.testing.assert_array_equal(parts(wrench.force), grasp.pose.axes @ felt.force)
    np.testing.assert_array_equal(parts(wrench.torque), grasp.pose.axes @ felt.torque)
    assert np.linalg.norm(felt.torque) > 1e-3
    wrenches = at_step(handled, 'colliders/wrenches', steps + 60)
    contacts = dict(zip(twin.colliders, forces.contacts))
    assert len(wrenches) == len(contacts) == 2
    for collider, contact in contacts.items():
        wrench = wrenches[FRAME.format(f'collider_{collider.name}')]
        np.testing.assert_array_equal(parts(wrench.force), collider.axes @ contact.force)
        np.testing.assert_array_equal(parts(wrench.torque), collider.axes @ contact.torque)
    assert contacts[twin.colliders[0]].force[2] < -0.1


def test_wrench_frames_of_held_nodes(handled, twin):
    """A viewer could not draw a wrench, or would count the force on a held node twice."""
    here = Pose(position=Point(x=-0.45, y=-0.35, z=1.0))
    assert handled.call(Grasp, 'grasp', name='hand', pose=here, radius=0.12).success
    assert handled.call(Step, 'step', steps=34).success
    at_step(handled, 'grasps/wrenches', 34)
    frames = {
        frame.child_frame_id: (frame.header.frame_id, frame.transform)
        for message in handled['tf'] for frame in message.transforms
        if handled.steps_of(frame) == 34}
    assert set(frames) == {FRAME.format(name) for name in (
        'grasp_hand', 'collider_ball', 'collider_floor', 'pin_0_0', 'pin_0_9')}
    parent, transform = frames[FRAME.format('collider_ball')]
    assert parent == 'world'
    assert parts(transform.translation).tolist() == [0.0, 0.0, 0.85]
    assert set(at_step(handled, 'pins/wrenches', 34)) == {
        FRAME.format('pin_0_0'), FRAME.format('pin_0_9')}


def test_the_parameters_turn_them_off(handled):
    """Topics nobody wants would still cost time."""
    assert handled.set_parameters(publish__wrenches=False, publish__tf=False).successful
    handled.client.spin_until_quiet()
    handled.clear()
    assert handled.call(Step, 'step', steps=2).success
    handled.frame(2)
    handled.client.spin_for(0.2)
    # On /tf there are other nodes, too.
    assert not handled['colliders/wrenches'] and not any(
        frame.child_frame_id.startswith(FRAME.format(''))
        for message in handled['tf'] for frame in message.transforms)


# What the topics show, against a simulation without a node on the same device.


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
    # A picture of the moment before may come after the answer.
    assert all(cloth.steps_of(cloud) != 2 for cloud in cloth['points'])
    assert all(cloth.steps_of(array.markers[0]) != 2 for array in cloth['markers'])
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


def test_a_cut_cloth_is_published_and_recorded(client, tmp_path):
    """The node would fill holes, pin what is not there, or record the path of a mask alone."""
    white = np.full((12, 14), 255, np.uint8)
    white[4:8, 3:9] = 0
    white[:3, :3] = 0
    Image.fromarray(white).save(tmp_path / 'mask.png')
    values = {
        'rows': 13, 'cols': 15, 'dt': 0.005, 'shape.mask': 'mask.png', 'pins': ['top_right'],
        'start_paused': True, 'recording.enabled': True, 'recording.name': 'cut'}
    with NodeProcess(tmp_path, values, '-r', '__ns:=/cut') as node:
        cloth = ClothUnderTest(client, values, '/cut/cloth_sim')
        cloud = cloth.wait_for('points')
        absent = np.isnan(cloth.points_of(cloud)['x'])
        assert not cloud.is_dense and (cloud.height, cloud.width) == (13, 15)
        # A corner of 3 x 3 cells has no inner node of others, the hole of 4 x 6 has 3 x 5.
        assert absent.sum() == 9 + 15 and absent[:3, :3].all() and absent[5:8, 4:9].all()
        answer = cloth.call(SetPin, 'set_pin', row=5, col=4, pinned=True)
        assert not answer.success and 'no node (5, 4) in the shape' in answer.message
        assert cloth.call(SetPin, 'set_pin', row=3, col=3, pinned=True).success
        answer = cloth.call(
            Grasp, 'grasp', name='hand', radius=0.3,
            pose=Pose(position=Point(x=-0.1, y=0.0, z=1.0), orientation=Quaternion(w=1.0)))
        assert answer.success, answer.message
        surface = cloth.wait_for('markers').markers[0]
        assert len(surface.points) == 6 * np.count_nonzero(white)
        assert cloth.call(Step, 'step', steps=20).success
        assert cloth.call(Trigger, 'stop_recording').success
        assert 'unexpected' not in node.output
    (tmp_path / 'mask.png').unlink()
    with made_again(tmp_path / 'bags' / 'cut', '/cut/cloth_sim') as rerun:
        assert rerun.check.equal == rerun.check.frames > 1
        assert np.count_nonzero(~rerun.simulation.scene.present_nodes) == absent.sum()
