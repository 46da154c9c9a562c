# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is given in any frame of tf or of the node, in the frame of the cloth."""

from collections import deque
from contextlib import suppress
from dataclasses import dataclass
import threading
from typing import Any

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.body_frames import body_poses
from cloth_sim_ros.messages.frame_messages import FrameContent
from cloth_sim_ros.messages.frame_names import camera_frame
from cloth_sim_ros.messages.frame_names import collider_frame
from cloth_sim_ros.messages.frame_names import grasp_frame
from cloth_sim_ros.messages.frame_names import node_of_pin
from cloth_sim_ros.messages.frame_names import pin_frame
from cloth_sim_ros.messages.stamp import NANOSECONDS
from cloth_sim_ros.messages.time_base import TimeBase
from cloth_sim_ros.node.frame_tree import checked_pose
from cloth_sim_ros.node.frame_tree import FrameHistory
from cloth_sim_ros.node.frame_tree import FrameTree
from cloth_sim_ros.node.frame_tree import KEPT
from cloth_sim_ros.node.frame_tree import MOST_SAMPLES
from cloth_sim_ros.node.frame_tree import read_transforms
from cloth_sim_ros.node.frame_tree import Sample
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.result_codes import UnknownFrameError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import product
from cloth_sim_ros.sim.model.pose import Quaternion
from cloth_sim_ros.sim.model.pose import turned
from cloth_sim_ros.sim.model.pose import Vector
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.subscription import Subscription
from tf2_msgs.msg import TFMessage

# Topics whose messages are given in the frames of pins, and in those of grasps and colliders.
_WITH_PINS = frozenset(('tf', 'pins/wrenches', 'pins/peak_wrenches'))
_WITH_BODIES = frozenset((
    'tf', 'grasps/wrenches', 'grasps/peak_wrenches', 'colliders/wrenches'))


class OwnFrames:
    """
    Where the frames are now, and were in the frames of the last seconds that were sent.

    All of it is used on the device thread.

    :param node_name: with its namespace
    :param frame_id: of the cloth, their parent
    :param base: of the stamps
    """

    def __init__(
            self, simulation: Simulation, node_name: str, frame_id: str, base: TimeBase) -> None:
        """Begin with the present."""
        self._simulation = simulation
        self._node_name = node_name
        self._frame_id = frame_id
        self._base = base
        self._prefixes = tuple(
            name(node_name, '') for name in (grasp_frame, collider_frame, _pins_frame))
        # Fixed in their parents: the tree has them.
        self.cameras = {
            camera_frame(node_name, camera.name): Sample(
                0, camera.frame or frame_id, camera.pose)
            for camera in simulation.scene.cameras}
        self._bodies: dict[str, FrameHistory] = {}
        # Time [ns], the pins as indices of nodes, and their positions (pins, 3).
        self._pins: deque[tuple[int, np.ndarray, np.ndarray]] = deque(maxlen=MOST_SAMPLES)

    def owns(self, frame: str) -> bool:
        """Return whether the name ``frame`` is one of those that the node gives."""
        return frame.startswith(self._prefixes) or frame in self.cameras

    def note(self, frame: FrameContent) -> None:
        """Remember where those are that have a transform in ``frame``."""
        if frame.keys & _WITH_PINS and frame.snapshot is not None and frame.pinned.any():
            self._note_pins(frame.snapshot)
        if frame.keys & _WITH_BODIES and (frame.grasps or frame.colliders):
            self._note_bodies()

    def _note_bodies(self) -> None:
        """Remember where grasps and colliders are now."""
        now, poses = self._base.at(self._simulation.time), self._body_poses()
        self._bodies = {name: self._bodies.get(name, FrameHistory()) for name in poses}
        for name, pose in poses.items():
            self._add(self._bodies[name], now, pose)

    def _note_pins(self, snapshot: Snapshot) -> None:
        """Remember where pins are in ``snapshot``."""
        now = self._base.at(snapshot.time)
        nodes = np.flatnonzero(self._pinned())
        while self._pins and not now - KEPT <= self._pins[0][0] <= now:
            self._pins.popleft()
        self._pins.append((now, nodes, snapshot.positions.reshape(-1, 3)[nodes]))

    def forget(self) -> None:
        """Drop the history: the time has gone back."""
        self._bodies.clear()
        self._pins.clear()

    def history(self, frame: str) -> FrameHistory | None:
        """
        Return where ``frame`` was, and is.

        None for a frame that is none of the node's own, and for one that is fixed in its parent.

        :raises ClothSimError: for one that the node could have, and does not have now
        """
        if not self.owns(frame) or frame in self.cameras:
            return None
        now, pose = self._base.at(self._simulation.time), self._body_poses().get(frame)
        if pose is not None:
            history = self._bodies.setdefault(frame, FrameHistory())
            self._add(history, now, pose)
            return history
        node = self._pin(frame)
        if node is None:
            raise UnknownFrameError(
                f'the frame {shown(frame)} would be of a grasp, a collider or a pin of this node '
                'that is not there: grasp or pin first, or give another frame')
        history = FrameHistory()
        for time, position in self._places(node[0] * self._simulation.scene.cols + node[1]):
            self._add(history, time, _at(position))
        self._add(history, now, _at(self._simulation.positions()[node]))
        return history

    def _add(self, history: FrameHistory, now: int, pose: Pose) -> None:
        # While the time stands still, the present can be another one than it was.
        history.drop_from(now)
        history.add(Sample(now, self._frame_id, pose))

    def _body_poses(self) -> dict[str, Pose]:
        simulation = self._simulation
        return body_poses(self._node_name, simulation.grasps, simulation.colliders)

    def _pin(self, frame: str) -> tuple[int, int] | None:
        """Return row and col of the pin of that name; None when there is none now."""
        node, scene = node_of_pin(frame), self._simulation.scene
        if node is None or pin_frame(self._node_name, *node) != frame:
            return None
        is_there = node[0] < scene.rows and node[1] < scene.cols and self._pinned()[node]
        return node if is_there else None

    def _pinned(self) -> np.ndarray:
        return self._simulation.pinned_nodes() & ~self._simulation.grasped_nodes()

    def _places(self, node: int) -> list[tuple[int, np.ndarray]]:
        """Return when and where ``node`` was a pin, for as long as it is one."""
        found = []
        for time, nodes, positions in reversed(self._pins):
            at = int(np.searchsorted(nodes, node))
            if at == len(nodes) or nodes[at] != node:
                break
            found.append((time, positions[at]))
        return found[::-1]


def _at(position: np.ndarray) -> Pose:
    x, y, z = map(float, position)
    return Pose((x, y, z))


def _pins_frame(node_name: str, _: str) -> str:
    return pin_frame(node_name, 0, 0).removesuffix('0_0')


# What is given in any frame of tf, in the frame of the cloth: listen to /tf and /tf_static.

# A robot at 1 kHz fills it between two calls of take_waiting.
_DEPTH = 1000


class _Unserved(CallbackGroup):
    """
    Keeps the executor from subscriptions.

    To wake for a message takes it ten times longer than to read that, and it takes one a turn.
    """

    def can_execute(self, entity: Any) -> bool:
        """Return False: nothing is ever to be called."""
        return False

    def beginning_execution(self, entity: Any) -> bool:
        """Return False likewise."""
        return False

    def ending_execution(self, entity: Any) -> None:
        """Do nothing."""


@dataclass(frozen=True)
class Given:
    """
    Turns numbers of a frame into those of the frame of the cloth.

    :param pose: of the frame; None for the frame of the cloth itself
    """

    pose: Pose | None = None

    def point(self, point: Any) -> Vector:
        """Return a message with x, y and z, a place, as numbers [m]."""
        x, y, z = self.vector(point)
        if self.pose is None:
            return x, y, z
        px, py, pz = self.pose.position
        return px + x, py + y, pz + z

    def vector(self, vector: Any) -> Vector:
        """Return a message with x, y and z, a force or a velocity, as numbers: turned alone."""
        parts = vector.x, vector.y, vector.z
        return parts if self.pose is None else turned(parts, self.pose.orientation)

    def orientation(self, orientation: Any) -> Quaternion:
        """Return a quaternion message as numbers x y z w; its length stays."""
        parts = orientation.x, orientation.y, orientation.z, orientation.w
        return parts if self.pose is None else product(self.pose.orientation, parts)


class InputFrames:
    """
    Keep the frames, and interpret headers.

    Headers are read on the device thread, and transforms taken on that of ROS as well.

    :param own: the frames of the node itself
    :param frame_id: of the cloth
    :param listens: False to know no others than these
    :param ignored: is given transforms that make no sense
    """

    def __init__(
            self, node: Node, own: OwnFrames, frame_id: str, ignored: IgnoredMessages, *,
            listens: bool) -> None:
        """Make the subscriptions."""
        self._own = own
        self._frame_id = frame_id
        self._ignored = ignored
        self._lock = threading.RLock()
        self._tree = FrameTree(
            own.history, 'publish it on /tf or /tf_static' if listens
            else 'start the node with tf.listen: true')
        for name, sample in own.cameras.items():
            self._tree.add(name, sample, is_fixed=True)
        self._subscriptions: list[tuple[Subscription, bool]] = []
        if listens:
            self._listen(node, '/tf_static', is_fixed=True)
            self._listen(node, '/tf', is_fixed=False)

    def given(self, header: Any) -> Given:
        """
        Return what turns the numbers of a message with ``header`` into those of the cloth's frame.

        :raises ClothSimError: when its frame is not known at its stamp
        """
        if header.frame_id in ('', self._frame_id):
            return Given()
        time = header.stamp.sec * NANOSECONDS + header.stamp.nanosec
        with self._lock:
            self.take_waiting()
            return Given(self._tree.pose(header.frame_id, self._frame_id, time or None))

    def place(self, frame: str, wanted: int) -> tuple[Pose, int | None]:
        """
        Return where a frame of tf is in the frame of the cloth, and of which time that is.

        :param wanted: the time [ns] of that, where it is known; the latest elsewhere
        :return: with None for a frame that is fixed
        :raises ClothSimError: when it is not known, or one of the node's own
        """
        if self._own.owns(frame) or frame == self._frame_id:
            raise ClothSimError(
                f'the frame {shown(frame)} is one of this node, and only one of tf can be '
                'followed: give a frame that another node publishes')
        with self._lock:
            self.take_waiting()
            latest = self._tree.latest_time(frame, self._frame_id)
            if latest is not None and wanted < latest:
                with suppress(UnknownFrameError):
                    return self._tree.pose(frame, self._frame_id, wanted), wanted
            return self._tree.pose(frame, self._frame_id, None), latest

    def note(self, frame: FrameContent) -> None:
        """Remember the poses of the node's own frames that have a transform in ``frame``."""
        with self._lock:
            self._own.note(frame)

    def forget(self) -> None:
        """Forget where frames were: the time has gone back. Fixed ones stay."""
        with self._lock:
            self.take_waiting()
            self._own.forget()
            self._tree.forget_moving()

    def take_waiting(self) -> None:
        """Take what has come on /tf and /tf_static; call it now and then, before it piles up."""
        with self._lock:
            for subscription, is_fixed in self._subscriptions:
                for _ in range(_DEPTH):
                    with subscription.handle:
                        taken = subscription.handle.take_message(TFMessage, True)
                    if taken is None:
                        break
                    self._keep(subscription.topic_name, taken[0], is_fixed)

    def _listen(self, node: Node, topic: str, *, is_fixed: bool) -> None:
        quality = QoSProfile(
            depth=_DEPTH, durability=DurabilityPolicy.TRANSIENT_LOCAL if is_fixed
            else DurabilityPolicy.VOLATILE)
        self._subscriptions.append((node.create_subscription(
            TFMessage, topic, _never_called, quality, callback_group=_Unserved(), raw=True),
            is_fixed))

    def _keep(self, topic: str, data: bytes, is_fixed: bool) -> None:
        try:
            for frame, time, parent, place in read_transforms(data):
                # What the node has sent itself, or a recording of it, comes in messages of its
                # own; where these frames are, it knows.
                if self._own.owns(frame):
                    return
                try:
                    sample = Sample(time, parent, checked_pose(frame, place))
                    self._tree.add(frame, sample, is_fixed=is_fixed)
                except ClothSimError as error:
                    self._ignored.note(topic, error)
        except ClothSimError as error:
            self._ignored.note(topic, error)


def _never_called(_: bytes) -> None:
    """Stand for the callback that each subscription has to have."""
