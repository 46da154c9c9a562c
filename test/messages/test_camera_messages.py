# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Messages of a picture have its numbers, and what image pipelines need to read them."""

from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.messages.camera_messages import camera_frames
from cloth_sim_ros.messages.camera_messages import CameraMessages
from cloth_sim_ros.messages.topics import camera_key
from cloth_sim_ros.messages.topics import CAMERA_PARTS
from cloth_sim_ros.messages.topics import topic_of
from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import PointField

CAMERA = CameraModel.of(
    'front', position=[0.0, 0.0, 1.0], target=[0.0, 0.0, 0.0], width=7, height=5,
    intrinsics=[8.0, 9.0, 3.25, 2.5])
FRAME = 'robot_cloth_sim_camera_front_optical'
EPOCH = 5_000_000_000


@pytest.fixture
def picture():
    """Return a picture of random numbers."""
    random = np.random.default_rng(3)
    depth = random.uniform(0.5, 2.0, (5, 7)).astype(np.float32)
    depth[0, 0], depth[1, 2] = np.inf, -np.inf
    return CameraPicture(
        CAMERA, CAMERA.pose, 1.25, random.integers(0, 256, (5, 7, 3)).astype(np.uint8), depth,
        random.integers(0, 4, (5, 7)).astype(np.uint8), None, None, ())


@pytest.fixture
def messages(picture):
    """Return all messages of it by the names of their parts."""
    keys = [camera_key('front', part) for part in CAMERA_PARTS]
    made = dict(CameraMessages(CAMERA, '/robot/cloth_sim').of(picture, keys, EPOCH))
    return {
        key.rpartition('/')[2]: deserialize_message(data, topic_of(key).message)
        for key, data in made.items()}


def test_all_have_one_stamp_and_the_optical_frame(messages):
    """A synchroniser would wait for ever, or a planner reach for another moment."""
    assert set(messages) == set(CAMERA_PARTS)
    for message in messages.values():
        assert (message.header.stamp.sec, message.header.stamp.nanosec) == (6, 250_000_000)
        assert message.header.frame_id == FRAME
        assert (message.height, message.width) == (5, 7)


@pytest.mark.parametrize('part, encoding, dtype, field', [
    ('image', 'rgb8', np.uint8, 'color'), ('depth', '32FC1', np.float32, 'depth'),
    ('labels', 'mono8', np.uint8, 'labels')])
def test_images_have_the_pixels(messages, picture, part, encoding, dtype, field):
    """Colours would be swapped, or depth be cut to bytes."""
    message, pixels = messages[part], getattr(picture, field)
    assert message.encoding == encoding and not message.is_bigendian
    assert message.step == pixels.nbytes // 5
    np.testing.assert_array_equal(
        np.frombuffer(message.data, dtype).reshape(pixels.shape), pixels)


def test_points_are_those_of_the_depth(messages, picture):
    """The cloud would not lie on the depth picture."""
    cloud = messages['points']
    assert (cloud.point_step, cloud.row_step, cloud.is_dense) == (12, 84, False)
    assert [(each.name, each.offset, each.datatype, each.count) for each in cloud.fields] == [
        (name, 4 * number, PointField.FLOAT32, 1) for number, name in enumerate('xyz')]
    points = np.frombuffer(cloud.data, np.float32).reshape(5, 7, 3)
    np.testing.assert_array_equal(points, picture.points())
    assert np.isnan(points[0, 0]).all() and np.isnan(points[1, 2]).all()
    assert np.isfinite(points).all(axis=-1).sum() == 33


def test_camera_info_has_the_pinhole(messages):
    """A pixel would be taken for another ray than it was drawn with."""
    info = messages['camera_info']
    np.testing.assert_array_equal(info.k, [8.0, 0.0, 3.25, 0.0, 9.0, 2.5, 0.0, 0.0, 1.0])
    np.testing.assert_array_equal(info.p.reshape(3, 4)[:, :3].ravel(), info.k)
    np.testing.assert_array_equal(info.p.reshape(3, 4)[:, 3], 0.0)
    np.testing.assert_array_equal(info.r, np.eye(3).ravel())
    assert info.distortion_model == 'plumb_bob' and list(info.d) == 5 * [0.0]


def test_only_what_is_read_is_made(picture):
    """A subscriber of one topic would pay for five."""
    made = CameraMessages(CAMERA, 'cloth_sim').of(picture, [camera_key('front', 'depth')])
    assert [key for key, _ in made] == ['cameras/front/depth']


def test_optical_frames_hang_on_what_they_are_attached_to():
    """A picture could not be placed in the world, or would be placed twice."""
    attached = CameraModel.of('hand', frame='tool0', position=[0.0, 0.0, 0.1])
    made = [message.transforms[0] for message in camera_frames(
        (CAMERA, attached), '/robot/cloth_sim', 1.25, 'world', EPOCH)]
    assert [(each.child_frame_id, each.header.frame_id) for each in made] == [
        (FRAME, 'world'), ('robot_cloth_sim_camera_hand_optical', 'tool0')]
    assert {each.header.stamp.sec for each in made} == {6}
    assert made[1].transform.translation.z == 0.1 and made[1].transform.rotation.w == 1.0
    # Straight down, with y up in the picture.
    turn = made[0].transform.rotation
    np.testing.assert_allclose(np.abs([turn.x, turn.y, turn.z, turn.w]), [1, 0, 0, 0], atol=1e-9)
