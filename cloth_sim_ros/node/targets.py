# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Requests to hold, release and move pins, grasps and colliders."""

from collections.abc import Callable
from collections.abc import Iterable
from functools import partial

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.srv import FollowFrame
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.followers import COLLIDER
from cloth_sim_ros.node.followers import Followers
from cloth_sim_ros.node.followers import GRASP
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.on_device import listen_on_device
from cloth_sim_ros.node.on_device import serve_on_device
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.sim.model.frame_paths import FramePath
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from rclpy.subscription import Subscription

# A controller at 1 kHz fills it in the time of a few frames.
_DEPTH = 100


class PinRequests:
    """
    Serve ~/set_pin and ~/move_pin, and listen to ~/pins/target.

    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, device: DeviceThread, simulation: Simulation, frames: InputFrames,
            ignored: IgnoredMessages) -> None:
        """Make the services and the subscription."""
        self._simulation = simulation
        self._frames = frames
        serve_on_device(node, device, SetPin, '~/set_pin', self._set)
        serve_on_device(node, device, MovePin, '~/move_pin', self._move)
        listen_on_device(
            node, device, PinTarget, '~/pins/target', _DEPTH, self._on_target, ignored)

    # Fields that are not set are 0 in ROS: that distance or speed means the usual one.
    def _set(self, request: SetPin.Request, response: SetPin.Response) -> str:
        row, col = request.row, request.col
        if request.use_point:
            point = self._frames.given(request.header).point(request.point)
            near = self._simulation.nearest_node(point, request.max_distance or None)
            row, col, response.distance = near.row, near.col, near.distance
        response.row, response.col = row, col
        if request.release:
            self._simulation.release(row, col)
        else:
            self._simulation.pin(row, col)
        place = f', {response.distance:.3f} m from the point' if request.use_point else ''
        return f'node ({row}, {col}) is {"free" if request.release else "pinned"}{place}'

    def _move(self, request: MovePin.Request, response: MovePin.Response) -> str:
        row, col = request.row, request.col
        given = self._frames.given(request.header)
        if request.use_point:
            near = self._simulation.nearest_pin(
                given.point(request.point), request.max_distance or None)
            row, col, response.distance = near.row, near.col, near.distance
        response.row, response.col = row, col
        x, y, z = target = given.point(request.target)
        response.arrival = self._simulation.move_pin(
            row, col, target, request.speed or None).arrival
        place = f', {response.distance:.3f} m from the point,' if request.use_point else ''
        return (
            f'node ({row}, {col}){place} moves to ({x:g}, {y:g}, {z:g}) and arrives at '
            f'{response.arrival:g} s')

    def _on_target(self, message: PinTarget) -> None:
        given = self._frames.given(message.header)
        self._simulation.move_pin(
            message.row, message.col, given.point(message.target), message.speed or None)


class GraspRequests:
    """
    Serve ~/grasp and ~/release.

    :param frames: says what headers mean
    :param followers: has what follows a frame
    """

    def __init__(
            self, node: Node, device: DeviceThread, simulation: Simulation,
            frames: InputFrames, followers: Followers) -> None:
        """Make the services."""
        self._simulation = simulation
        self._frames = frames
        self._followers = followers
        serve_on_device(node, device, Grasp, '~/grasp', self._grasp)
        serve_on_device(node, device, Release, '~/release', self._release)

    def _grasp(self, request: Grasp.Request, response: Grasp.Response) -> str:
        given = self._frames.given(request.header)
        if request.follow_frame:
            # Before anything has changed.
            self._followers.look_up(request.follow_frame)
        grasp = self._simulation.grasp(
            request.name, given.point(request.pose.position),
            given.orientation(request.pose.orientation), radius=request.radius,
            count=request.count, layers=request.layers or Grasp.Request.ALL,
            max_force=request.max_force)
        response.nodes = len(grasp.nodes)
        text = f'grasp {grasp.name} holds {response.nodes} nodes'
        if request.follow_frame:
            self._followers.attach(GRASP, grasp.name, request.follow_frame)
            text += f' and follows {request.follow_frame}'
        return text

    def _release(self, request: Release.Request, response: Release.Response) -> str:
        names = [request.name] if request.name else [
            grasp.name for grasp in self._simulation.grasps]
        for name in names:
            response.nodes += len(self._simulation.release_grasp(name).nodes)
        what = f'grasp {request.name}' if request.name else f'{len(names)} grasps'
        return f'{response.nodes} nodes of {what} are free'


# Grasps and colliders that are moved from outside, by services and by streams of poses.

# Messages that are farther apart are no stream [s].
LONGEST_GAP = 0.2

Move = Callable[..., FramePath]


class MoveRequests:
    """
    Serve ~/move_grasp, ~/move_collider, ~/follow_grasp and ~/follow_collider.

    Listen to ~/colliders/NAME/pose of each collider.

    ``follow`` listens to ~/grasps/NAME/target of grasps.

    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    :param followers: has what follows a frame
    """

    def __init__(
            self, node: Node, device: DeviceThread, simulation: Simulation, frames: InputFrames,
            ignored: IgnoredMessages, followers: Followers) -> None:
        """Make the services, and the subscriptions of the scene's colliders and grasps."""
        self._followers = followers
        self._node = node
        self._device = device
        self._simulation = simulation
        self._frames = frames
        self._ignored = ignored
        self._of_scene = {grasp.name for grasp in simulation.scene.timed_grasps()}
        self._subscriptions: dict[str, Subscription] = {}
        for kind, move in ((GRASP, simulation.move_grasp), (COLLIDER, simulation.move_collider)):
            serve_on_device(
                node, device, MoveFrame, f'~/move_{kind}', partial(self._on_request, kind, move))
            serve_on_device(
                node, device, FollowFrame, f'~/follow_{kind}', partial(self._on_follow, kind))
        for collider in simulation.scene.colliders:
            self._listen(f'~/colliders/{collider.name}/pose', COLLIDER, collider.name)
        self.follow(())

    def follow(self, grasps: Iterable[str]) -> None:
        """Listen for ``grasps`` and those of the scene, and for no others."""
        wanted = self._of_scene | set(grasps)
        for name in self._subscriptions.keys() - wanted:
            self._node.destroy_subscription(self._subscriptions.pop(name))
        for name in sorted(wanted - self._subscriptions.keys()):
            self._subscriptions[name] = self._listen(f'~/grasps/{name}/target', GRASP, name)

    # Fields that are not set are 0 in ROS: that speed means the usual one.
    def _on_request(
            self, kind: str, move: Move, request: MoveFrame.Request,
            response: MoveFrame.Response) -> str:
        self._followers.check_free(kind, request.name)
        given = self._frames.given(request.header)
        x, y, z = target = given.point(request.pose.position)
        path = move(
            request.name, target,
            None if request.keep_orientation else given.orientation(request.pose.orientation),
            request.speed or None, request.angular_speed or None)
        response.arrival = path.arrival
        return (
            f'{kind} {request.name} moves to ({x:g}, {y:g}, {z:g}) and arrives at '
            f'{path.arrival:g} s')

    def _on_follow(
            self, kind: str, request: FollowFrame.Request, _: FollowFrame.Response) -> str:
        if not request.frame:
            follower = self._followers.detach(kind, request.name)
            return f'{kind} {request.name} no longer follows {follower.frame}'
        self._followers.attach(
            kind, request.name, request.frame, request.max_speed, request.max_angular_speed)
        return f'{kind} {request.name} follows {request.frame}'

    def _listen(self, topic: str, kind: str, name: str) -> Subscription:
        intervals = Intervals()
        simulation = self._simulation
        move: Move = simulation.move_grasp if kind == GRASP else simulation.move_collider

        def on_pose(message: PoseStamped) -> None:
            self._followers.check_free(kind, name)
            duration = intervals.before(simulation.time)
            given = self._frames.given(message.header)
            move(
                name, given.point(message.pose.position),
                given.orientation(message.pose.orientation), duration=duration)

        return listen_on_device(
            self._node, self._device, PoseStamped, topic, _DEPTH, on_pose, self._ignored)


class Intervals:
    """The times between messages of a stream."""

    def __init__(self) -> None:
        """Begin before the first message."""
        self._latest = -1.0
        self._interval = 0.0

    def before(self, now: float) -> float:
        """
        Return how long before ``now`` the message before was [s]; 0 where that is no stream.

        Messages that come at the same time have the interval of the first of them.
        """
        if now != self._latest:
            passed = now - self._latest
            self._interval = passed if 0.0 < passed <= LONGEST_GAP else 0.0
            self._latest = now
        return self._interval
