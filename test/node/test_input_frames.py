# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Inputs in other frames than that of the cloth, with a node that receives tf."""

from collections.abc import Iterator
from pathlib import Path

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.messages.body_frames import pose_message
from cloth_sim_ros.sim.model.pose import Pose
from cloth_under_test import HANDLED
from cloth_under_test import PAUSED
from geometry_msgs.msg import Point
from geometry_msgs.msg import PointStamped
from geometry_msgs.msg import PoseStamped
from geometry_msgs.msg import Vector3
from made_again import assert_same
from node_process import NodeProcess
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from std_msgs.msg import Header
from std_srvs.srv import Trigger
from transform_teller import Teller
from transform_teller import transform

OWN = 'handled_cloth_sim_{}'
# Pose of a camera that looks at the cloth.
TURN = Rotation.from_euler('xyz', (0.4, -1.1, 2.0))
PLACE = np.array([0.3, -0.2, 1.7])
CAMERA = Pose(tuple(PLACE.tolist()), tuple(TURN.as_quat().tolist()))
IN_CAMERA = Header(frame_id='camera', stamp=Time(sec=1_700_000_000))
FORCE = (0.4, -0.2, 0.7)


def seen_by_camera(point) -> Point:
    """Return ``point`` of the world as the camera has it."""
    x, y, z = TURN.inv().apply(np.array(point) - PLACE).tolist()
    return Point(x=x, y=y, z=z)


def numbers(message) -> list[float]:
    """Return x, y, z and, of an orientation, w."""
    return [getattr(message, part) for part in 'xyzw' if hasattr(message, part)]


@pytest.fixture
def teller(handled) -> Iterator[Teller]:
    """Return who publishes transforms to the node."""
    teller = Teller(handled)
    yield teller
    teller.close()


@pytest.fixture
def camera(teller):
    """Tell where the camera is."""
    teller.tell(transform('camera', 'world', CAMERA), is_fixed=True)


def publish(cloth, kind, topic, message, key):
    """Publish ``message``, and return the input that the node publishes for it."""
    publisher = cloth.client.node.create_publisher(kind, topic, 10)
    cloth.client.spin_until(publisher.get_subscription_count, 'the node listens')
    count = len(cloth[key])
    publisher.publish(message)
    cloth.client.spin_until(lambda: len(cloth[key]) > count, f'{topic} is taken')
    cloth.client.node.destroy_publisher(publisher)
    return cloth[key][-1]


def near(found, expected):
    """Hold numbers to what is expected, as far as rounding allows."""
    np.testing.assert_allclose(numbers(found), expected, atol=1e-12)


def test_services_take_places_poses_and_forces_of_a_camera(handled, camera):
    """A request in the frame of a camera would act elsewhere, or in another direction."""
    corner = seen_by_camera((-0.45, -0.35, 1.0))
    no_turn = pose_message(CAMERA.inverse).orientation
    call = handled.call
    response = call(
        Grasp, 'grasp', header=IN_CAMERA, name='hand', count=1,
        pose=pose_message(Pose(
            tuple(numbers(corner)), tuple(numbers(no_turn)))))
    assert response.success, response.message
    told = handled.wait_for('inputs/grasp')
    assert told.header.frame_id == 'world'
    near(told.pose.position, (-0.45, -0.35, 1.0))
    assert (told.rows.tolist(), told.cols.tolist()) == ([7], [0])
    assert abs(told.pose.orientation.w) == pytest.approx(1.0, abs=1e-12)
    goal = Pose((0.1, 0.2, 0.3), (0.0, 0.6, 0.0, 0.8))
    expected = CAMERA.placed(goal)
    for service, name, key in (
            ('move_grasp', 'hand', 'inputs/grasp_target'),
            ('move_collider', 'ball', 'inputs/collider_target')):
        response = call(
            MoveFrame, service, header=IN_CAMERA, name=name, pose=pose_message(goal))
        assert response.success
        x, y, z = expected.position
        assert f'moves to ({x:g}, {y:g}, {z:g})' in response.message
        told = handled.wait_for(key)
        near(told.pose.position, expected.position)
        near(told.pose.orientation, expected.orientation)
    x, y, z = FORCE
    response = call(
        ApplyPush, 'apply_push', header=IN_CAMERA, force=Vector3(x=x, y=y, z=z),
        region='sphere', center=seen_by_camera((0.45, -0.35, 1.0)), radius=0.05, duration=0.1)
    assert (response.success, response.nodes) == (True, 1)
    near(response.impulse, 0.1 * TURN.apply(FORCE))
    told = handled.wait_for('inputs/push')
    near(told.force, TURN.apply(FORCE))
    near(told.center, (0.45, -0.35, 1.0))
    response = call(
        SetPin, 'set_pin', header=IN_CAMERA, use_point=True,
        point=seen_by_camera((0.45, -0.35, 1.0)), max_distance=0.01)
    assert (response.success, response.row, response.col) == (True, 7, 9)
    response = call(
        MovePin, 'move_pin', header=IN_CAMERA, use_point=True, max_distance=0.01,
        point=seen_by_camera((0.45, -0.35, 1.0)), target=seen_by_camera((0.4, -0.3, 1.1)))
    assert (response.success, response.row, response.col) == (True, 7, 9)
    near(handled.wait_for('inputs/pin_target').target, (0.4, -0.3, 1.1))


def test_topics_take_places_poses_and_forces_of_a_camera(handled, camera):
    """A controller that streams in the frame of a camera would move things elsewhere."""
    x, y, z = FORCE
    told = publish(handled, Push, f'{handled.name}/push', Push(
        header=IN_CAMERA, force=Vector3(x=x, y=y, z=z), region='sphere', radius=0.3,
        center=seen_by_camera((0.1, 0.0, 1.0)), duration=0.1), 'inputs/push')
    near(told.force, TURN.apply(FORCE))
    near(told.center, (0.1, 0.0, 1.0))
    told = publish(handled, PointStamped, '/clicked_point', PointStamped(
        header=IN_CAMERA, point=seen_by_camera((0.2, 0.0, 1.0))), 'inputs/push')
    near(told.center, (0.2, 0.0, 1.0))
    # Its force is a parameter, which has no other frame than that of the cloth.
    near(told.force, (0.0, 0.0, 1.0))
    told = publish(handled, PinTarget, f'{handled.name}/pins/target', PinTarget(
        header=IN_CAMERA, target=seen_by_camera((-0.4, 0.3, 1.1))), 'inputs/pin_target')
    near(told.target, (-0.4, 0.3, 1.1))
    goal = Pose((0.1, 0.2, 0.3), (0.0, 0.6, 0.0, 0.8))
    told = publish(handled, PoseStamped, f'{handled.name}/colliders/ball/pose', PoseStamped(
        header=IN_CAMERA, pose=pose_message(goal)), 'inputs/collider_target')
    near(told.pose.position, CAMERA.placed(goal).position)
    near(told.pose.orientation, CAMERA.placed(goal).orientation)


def test_a_moving_frame_is_taken_at_the_stamp(handled, teller):
    """An input would be taken where its frame is now, or a stamp of the future be guessed."""
    handled.call(Trigger, 'reset')
    teller.tell(*(
        transform('arm', 'world', Pose((0.1 * time, 0.0, 0.0)), time) for time in (1.0, 2.0)))

    def moved(stamp: Time):
        handled.clear()
        response = handled.call(
            MoveFrame, 'move_collider', header=Header(frame_id='arm', stamp=stamp), name='ball',
            pose=pose_message(Pose((0.0, 0.0, 0.85))))
        assert response.success, response.message
        return handled.wait_for('inputs/collider_target').pose.position

    near(moved(Time(sec=1, nanosec=250_000_000)), (0.125, 0.0, 0.85))
    near(moved(Time()), (0.2, 0.0, 0.85))
    teller.tell(transform('arm', 'world', Pose((0.3, 0.0, 0.0)), 2.5))
    near(moved(Time()), (0.3, 0.0, 0.85))
    assert teller.refusal(Header(frame_id='arm', stamp=Time(sec=3))) == (
        "the stamp of its frame 'arm' is 3 s but 'arm' is known from 1 to 2.5 s: give a stamp in "
        'between, or 0 for the latest')


def test_input_in_an_unknown_frame_is_refused(handled, teller, twin):
    """A refused input would be applied in part: a push in a wrong direction, or a pin at NaN."""
    teller.tell(transform('lonely', 'island', CAMERA), transform('arm', 'world', CAMERA))
    for frame, rule in (
            ('tool0', "its frame 'tool0' is not known: publish it on /tf or /tf_static"),
            ('lonely', "its frame 'lonely' is not connected to 'world', the frame of the cloth: "),
            ('/world', "its frame '/world' is not known"),
            (OWN.format('grasp_nobody'), 'that is not there: grasp or pin first'),
            (OWN.format('pin_3_3'), 'that is not there: grasp or pin first')):
        assert rule in teller.refusal(Header(frame_id=frame))
        header = Header(frame_id=frame)
        for kind, service, fields in (
                (ApplyPush, 'apply_push', {'force': Vector3(z=1.0), 'duration': 0.1}),
                (SetPin, 'set_pin', {'use_point': True, 'max_distance': 9.0}),
                (MovePin, 'move_pin', {'target': Point(z=1.0)}),
                (Grasp, 'grasp', {'name': 'hand', 'radius': 9.0})):
            response = handled.call(kind, service, header=header, **fields)
            assert not response.success and rule in response.message
    assert handled.call(Step, 'step', steps=5).success
    twin.step(5)
    assert handled.frame(5).tobytes() == twin.snapshot().records.tobytes()
    for key in ('push', 'pin', 'pin_target', 'grasp', 'collider_target'):
        assert not handled[f'inputs/{key}']


def test_the_frames_of_the_node_itself_are_known(handled, teller, twin):
    """A hand that pushes along its own axes, or replies to a wrench, would be refused."""
    begin, turn = (-0.5, -0.3, 1.0), (0.0, 0.6, 0.0, 0.8)
    here = pose_message(Pose(begin, turn))
    assert handled.call(Grasp, 'grasp', name='hand', pose=here, radius=0.2).success
    assert handled.call(
        MoveFrame, 'move_grasp', name='hand', speed=0.5,
        pose=pose_message(Pose((-0.5, -0.3, 1.3)))).success
    assert handled.call(
        MovePin, 'move_pin', row=0, col=0, target=Point(x=-0.45, y=0.35, z=1.2)).success
    twin.grasp('hand', begin, turn, radius=0.2)
    twin.move_grasp('hand', (-0.5, -0.3, 1.3), (0.0, 0.0, 0.0, 1.0), speed=0.5)
    twin.move_pin(0, 0, (-0.45, 0.35, 1.2))
    places = {}
    for steps in (20, 20):
        assert handled.call(Step, 'step', steps=steps).success
        twin.step(steps)
        pin = Pose(tuple(map(float, twin.positions()[0, 0])))
        places[twin.steps] = {
            'grasps/wrenches': twin.grasps[0].pose, 'pins/wrenches': pin,
            'colliders/wrenches': Pose((0.0, 0.0, 0.85))}
    teller.tell(
        transform('on_hand', OWN.format('grasp_hand'), Pose((0.0, 0.1, 0.0))), is_fixed=True)
    frames = ('grasp_hand', 'pin_0_0', 'collider_ball')
    headers = {(key, steps): handled.wait_for(key, lambda message: (
        handled.steps_of(message) == steps and message.header.frame_id == OWN.format(name))).header
        for key, name in zip(places[40], frames) for steps in places}
    for (key, steps), header in headers.items():
        check_push(handled, header, places[steps][key])
        check_push(handled, Header(frame_id=header.frame_id), places[40][key])
    check_push(handled, Header(frame_id='on_hand'), places[40]['grasps/wrenches'].placed(
        Pose((0.0, 0.1, 0.0))))
    late = Header(frame_id=OWN.format('grasp_hand'), stamp=Time(sec=5))
    assert "is 5 s but 'handled_cloth_sim_grasp_hand' is known from" in teller.refusal(late)


def check_push(cloth, header: Header, pose: Pose) -> None:
    """Push in the frame of ``header``, which is to be at ``pose``."""
    cloth.clear()
    x, y, z = FORCE
    response = cloth.call(
        ApplyPush, 'apply_push', header=header, force=Vector3(x=x, y=y, z=z), duration=0.1,
        region='sphere', center=Point(x=0.1, y=-0.2, z=0.3), radius=3.0)
    assert response.success, response.message
    told = cloth.wait_for('inputs/push')
    turn = Rotation.from_quat(pose.orientation)
    near(told.force, turn.apply(FORCE))
    near(told.center, pose.position + turn.apply((0.1, -0.2, 0.3)))


def test_what_others_tell_of_its_own_frames_does_not_count(handled, teller):
    """A recording that is played beside the node would move its grasps and pins for inputs."""
    elsewhere = Pose((9.0, 9.0, 9.0))
    ball = OWN.format('collider_ball')
    teller.tell(transform(ball, 'world', elsewhere))
    teller.tell(transform('late', 'world', elsewhere))
    check_push(handled, Header(frame_id=ball), Pose((0.0, 0.0, 0.85)))


def test_a_transform_that_makes_no_sense_is_left_out(handled, teller):
    """One joint without a position would hide all others of a robot."""
    nowhere = Pose((float('nan'), 0.0, 0.0))
    teller.tell(transform('broken', 'world', nowhere), transform('whole', 'world', CAMERA))
    assert "its frame 'broken' is not known" in teller.refusal(Header(frame_id='broken'))


def test_a_reset_forgets_moving_frames_and_keeps_fixed_ones(handled, teller, camera):
    """Times before the reset would be mixed with those after it."""
    teller.tell(transform('arm', 'world', CAMERA, 7.0))
    assert handled.call(Trigger, 'reset').success
    assert "its frame 'arm' is not known" in teller.refusal(Header(frame_id='arm'))
    assert 'there is no collider' in teller.refusal(IN_CAMERA)
    teller.tell(transform('arm', 'world', CAMERA, 0.01))


def test_a_recorded_run_is_made_again_without_tf(handled, teller, camera):
    """A recording would have inputs in frames that nobody knows any more."""
    teller.tell(transform('arm', 'world', CAMERA.inverse, 1.0))
    path = Path(handled.call(StartRecording, 'start_recording').path)
    pose = pose_message(Pose(tuple(numbers(seen_by_camera((-0.45, -0.35, 1.0))))))
    for number, (kind, service, fields) in enumerate((
            (ApplyPush, 'apply_push', {'force': Vector3(x=0.3, z=0.2), 'duration': 0.2}),
            (Grasp, 'grasp', {'name': 'hand', 'radius': 0.12, 'pose': pose}),
            (MoveFrame, 'move_collider', {'name': 'ball', 'pose': pose}),
            (MoveFrame, 'move_grasp', {
                'name': 'hand', 'pose': pose_message(Pose((0.1, 0.0, 0.6)))}),
            (MovePin, 'move_pin', {'target': seen_by_camera((-0.4, 0.3, 1.1))}))):
        response = handled.call(kind, service, header=IN_CAMERA, **fields)
        assert response.success, response.message
        handled.call(ApplyPush, 'apply_push', header=Header(frame_id=('arm', OWN.format(
            'pin_0_9'))[number % 2]), force=Vector3(y=0.1), duration=0.01)
        assert handled.call(Step, 'step', steps=12).success
    handled.call(Trigger, 'stop_recording')
    assert_same(path, node=handled.name)


def test_a_node_that_does_not_listen_says_so(client, tmp_path):
    """A user who has turned it off would look for a mistake in his transforms."""
    with NodeProcess(tmp_path, {**HANDLED, **PAUSED, 'tf.listen': False}, '-r', '__ns:=/deaf'):
        # The graph may know a service before it knows its node, or the node its client.
        client.spin_until(
            lambda: ('cloth_sim', '/deaf') in client.node.get_node_names_and_namespaces(),
            'the node is known')
        response = client.call_until_answered(
            ApplyPush, '/deaf/cloth_sim/apply_push', header=IN_CAMERA, force=Vector3(z=1.0),
            duration=0.1)
        assert response.message == (
            "its frame 'camera' is not known: start the node with tf.listen: true, or give "
            "another one, such as 'world', the frame of the cloth")
        assert not {'/tf', '/tf_static'} & {
            name for name, _ in client.node.get_subscriber_names_and_types_by_node(
                'cloth_sim', '/deaf')}
        # Its own frames it knows nevertheless.
        response = client.call(
            ApplyPush, '/deaf/cloth_sim/apply_push', duration=0.1, force=Vector3(z=1.0),
            header=Header(frame_id='deaf_cloth_sim_pin_0_0'))
        assert response.success, response.message
