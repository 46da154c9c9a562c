# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The pictures of a camera as messages, and its optical frame."""

from collections.abc import Collection
from collections.abc import Iterator
from collections.abc import Sequence

from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.camera.picture import points_of
from cloth_sim_ros.messages.body_frames import body_frames
from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.messages.frame_names import camera_frame
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.messages.stamp import stamp_parts
from cloth_sim_ros.messages.topics import camera_key
from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np
from rclpy.serialization import serialize_message
from sensor_msgs.msg import CameraInfo
from sensor_msgs.msg import PointField
from std_msgs.msg import Header
from tf2_msgs.msg import TFMessage

# Bytes of a point: x y z.
_POINT_BYTES = 12
_FIELDS = ('x', 'y', 'z')


class CameraMessages:
    """
    Makes the messages of one camera, in the bytes that go out.

    :param node_name: with its namespace
    """

    def __init__(self, camera: CameraModel, node_name: str) -> None:
        """Prepare what stays the same from picture to picture."""
        self._camera = camera
        self._frame_id = camera_frame(node_name, camera.name)
        self._rays = camera.rays().astype(np.float32)

    def of(
            self, picture: CameraPicture, keys: Collection[str],
            epoch: int = 0) -> Iterator[tuple[str, bytes]]:
        """
        Yield the key of a topic and each message that is among ``keys``.

        :param epoch: stamp of simulated time 0 [ns]
        """
        name = self._camera.name
        images = (
            ('image', 'rgb8', picture.color), ('depth', '32FC1', picture.depth),
            ('labels', 'mono8', picture.labels))
        if camera_key(name, 'camera_info') in keys:
            yield camera_key(name, 'camera_info'), serialize_message(
                camera_info(self._camera, self._frame_id, picture.time, epoch))
        for part, encoding, pixels in images:
            if camera_key(name, part) in keys and pixels is not None:
                yield camera_key(name, part), self._image(picture.time, encoding, pixels, epoch)
        if camera_key(name, 'points') in keys and picture.depth is not None:
            yield camera_key(name, 'points'), self._points(picture.time, picture.depth, epoch)

    def _header(self, time: float, epoch: int) -> CdrWriter:
        writer = CdrWriter()
        seconds, nanoseconds = stamp_parts(time, epoch)
        writer.put('i', seconds)
        writer.put('I', nanoseconds)
        writer.put_string(self._frame_id)
        return writer

    def _image(self, time: float, encoding: str, pixels: np.ndarray, epoch: int) -> bytes:
        """Return a sensor_msgs/Image."""
        writer = self._header(time, epoch)
        height, width = pixels.shape[:2]
        step = pixels.nbytes // height
        writer.put('I', height, width)
        writer.put_string(encoding)
        writer.put('B', 0)  # is_bigendian
        writer.put('I', step)
        writer.put_sequence(pixels.reshape(-1).view(np.uint8))
        return writer.finish()

    def _points(self, time: float, depth: np.ndarray, epoch: int) -> bytes:
        """Return an organised sensor_msgs/PointCloud2 in the optical frame."""
        height, width = depth.shape
        writer = self._header(time, epoch)
        writer.put('I', height, width)
        writer.put('I', len(_FIELDS))
        for number, name in enumerate(_FIELDS):
            writer.put_string(name)
            writer.put('I', 4 * number)
            writer.put('B', PointField.FLOAT32)
            writer.put('I', 1)
        writer.put('B', 0)  # is_bigendian
        writer.put('I', _POINT_BYTES, _POINT_BYTES * width)
        writer.put_sequence(points_of(depth, self._rays).reshape(-1).view(np.uint8))
        writer.put('B', 0)  # is_dense: points are NaN where nothing is
        return writer.finish()


def camera_info(
        camera: CameraModel, frame_id: str, time: float, epoch: int = 0) -> CameraInfo:
    """Return what image pipelines need of ``camera``: a pinhole without distortion."""
    k = camera.matrix
    return CameraInfo(
        header=Header(stamp=stamp(time, epoch), frame_id=frame_id), height=camera.height,
        width=camera.width, distortion_model='plumb_bob', d=5 * [0.0],
        k=k.ravel(), r=np.eye(3).ravel(), p=np.hstack([k, np.zeros((3, 1))]).ravel())


def camera_frames(
        cameras: Sequence[CameraModel], node_name: str, sim_time: float, frame_id: str,
        epoch: int = 0) -> Iterator[TFMessage]:
    """
    Yield the optical frames of ``cameras`` at ``sim_time`` [s].

    :param frame_id: their parent, unless they are attached to a frame of tf
    """
    for camera in cameras:
        yield body_frames(
            {camera_frame(node_name, camera.name): camera.pose}, sim_time,
            camera.frame or frame_id, epoch)
