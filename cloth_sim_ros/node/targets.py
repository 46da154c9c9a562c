# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pins, grasps and colliders that are held, let go and moved from outside."""

from collections.abc import Callable
from functools import partial

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.srv import Grasp
from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import Release
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.outlet import Inputs
from cloth_sim_ros.node.refusals import answer
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.frame_paths import FramePath
from cloth_sim_ros.sim.handling import InputListener
from cloth_sim_ros.sim.pins import PinPath
from cloth_sim_ros.sim.pose import Vector
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from rclpy.subscription import Subscription

# A controller at 1 kHz fills it in the time of a few frames.
_DEPTH = 100


class PinService:
    """
    Serve ~/set_pin.

    :param frames: says what headers mean
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs,
            frames: InputFrames) -> None:
        """Make the service."""
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        node.create_service(SetPin, '~/set_pin', answer(self._set_pin))

    def _set_pin(self, request: SetPin.Request, response: SetPin.Response) -> str:
        row, col = request.row, request.col
        if request.use_point:
            # Fields that are not set are 0 in ROS: that distance means the usual one.
            point = self._frames.given(request.header).point(request.point)
            near = self._simulation.nearest_node(point, request.max_distance or None)
            row, col, response.distance = near.row, near.col, near.distance
        response.row, response.col = row, col
        if request.release:
            self._simulation.release(row, col)
        else:
            self._simulation.pin(row, col)
        self._inputs.pin(row, col, not request.release)
        place = f', {response.distance:.3f} m from the point' if request.use_point else ''
        return f'node ({row}, {col}) is {"free" if request.release else "pinned"}{place}'


class PinTargets:
    """
    Serve ~/move_pin and listen to ~/pins/target.

    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frames: InputFrames,
            ignored: IgnoredMessages) -> None:
        """Make the service and the subscription."""
        self._ignored = ignored
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        node.create_service(MovePin, '~/move_pin', answer(self._on_request))
        node.create_subscription(PinTarget, '~/pins/target', self._on_message, _DEPTH)

    # Fields that are not set are 0 in ROS: that distance or speed means the usual one.
    def _on_request(self, request: MovePin.Request, response: MovePin.Response) -> str:
        row, col = request.row, request.col
        given = self._frames.given(request.header)
        if request.use_point:
            near = self._simulation.nearest_pin(
                given.point(request.point), request.max_distance or None)
            row, col, response.distance = near.row, near.col, near.distance
        response.row, response.col = row, col
        x, y, z = target = given.point(request.target)
        response.arrival = self._move(row, col, target, request.speed).arrival
        place = f', {response.distance:.3f} m from the point,' if request.use_point else ''
        return (
            f'node ({row}, {col}){place} moves to ({x:g}, {y:g}, {z:g}) and arrives at '
            f'{response.arrival:g} s')

    def _on_message(self, message: PinTarget) -> None:
        try:
            given = self._frames.given(message.header)
            self._move(message.row, message.col, given.point(message.target), message.speed)
        except ClothSimError as error:
            self._ignored.note('~/pins/target', error)

    def _move(self, row: int, col: int, target: Vector, speed: float) -> PinPath:
        path = self._simulation.move_pin(row, col, target, speed or None)
        self._inputs.pin_target(path.move)
        return path


class GraspServices:
    """
    Serve ~/grasp and ~/release.

    :param frames: says what headers mean
    :param changed: called when there are other grasps than before
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frames: InputFrames,
            changed: Callable[[], None]) -> None:
        """Make the services."""
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        self._changed = changed
        node.create_service(Grasp, '~/grasp', answer(self._on_grasp))
        node.create_service(Release, '~/release', answer(self._on_release))

    def _on_grasp(self, request: Grasp.Request, response: Grasp.Response) -> str:
        given = self._frames.given(request.header)
        grasp = self._simulation.grasp(
            request.name, given.point(request.pose.position),
            given.orientation(request.pose.orientation), radius=request.radius,
            count=request.count, max_force=request.max_force)
        self._inputs.grasp(grasp)
        self._changed()
        response.nodes = len(grasp.nodes)
        return f'grasp {grasp.name} holds {response.nodes} nodes'

    def _on_release(self, request: Release.Request, response: Release.Response) -> str:
        names = [request.name] if request.name else [
            grasp.name for grasp in self._simulation.grasps]
        for name in names:
            grasp = self._simulation.release_grasp(name)
            self._inputs.grasp_release(name, False)
            response.nodes += len(grasp.nodes)
        self._changed()
        what = f'grasp {request.name}' if request.name else f'{len(names)} grasps'
        return f'{response.nodes} nodes of {what} are free'


class LostGrasps(InputListener):
    """
    Hear of grasps that the cloth has pulled too hard at; of all else their services tell.

    :param changed: called when there are other grasps than before
    """

    def __init__(
            self, inputs: Inputs, warn: Callable[[str], object],
            changed: Callable[[], None]) -> None:
        """Wait for one."""
        self._inputs = inputs
        self._warn = warn
        self._changed = changed

    def grasp_release(self, name: str, by_force: bool) -> None:
        """Warn, and tell."""
        if not by_force:
            return
        self._warn(
            f'grasp {name} has lost the cloth, which pulled harder than its max_force: grasp '
            'again, and move it more slowly or give it a higher max_force')
        self._inputs.grasp_release(name, True)
        self._changed()


# Grasps and colliders that are moved from outside, by services and by streams of poses.

# Messages that are farther apart are no stream [s].
LONGEST_GAP = 0.2

Move = Callable[..., FramePath]
Tell = Callable[[FrameMove], None]


class MoveServices:
    """
    Serve ~/move_grasp and ~/move_collider.

    :param frames: says what headers mean
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs,
            frames: InputFrames) -> None:
        """Make the services."""
        node.create_service(MoveFrame, '~/move_grasp', answer(
            partial(_on_request, 'grasp', simulation.move_grasp, inputs.grasp_move, frames)))
        node.create_service(MoveFrame, '~/move_collider', answer(partial(
            _on_request, 'collider', simulation.move_collider, inputs.collider_move, frames)))


class PoseStreams:
    """
    Listen to ~/grasps/NAME/target of each grasp and ~/colliders/NAME/pose of each collider.

    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frames: InputFrames,
            ignored: IgnoredMessages) -> None:
        """Make the subscriptions of the scene's colliders and grasps."""
        self._node = node
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        self._ignored = ignored
        self._of_scene = {grasp.name for grasp in simulation.scene.timed_grasps()}
        self._subscriptions: dict[str, Subscription] = {}
        for collider in simulation.colliders:
            node.create_subscription(
                PoseStamped, '~/colliders/NAME/pose'.replace('NAME', collider.name),
                self._follow(
                    '~/colliders/NAME/pose', simulation.move_collider, collider.name,
                    inputs.collider_move), _DEPTH)
        self.follow_grasps()

    def follow_grasps(self) -> None:
        """Listen for the present grasps and those of the scene, and for no others."""
        wanted = self._of_scene | {grasp.name for grasp in self._simulation.grasps}
        for name in self._subscriptions.keys() - wanted:
            self._node.destroy_subscription(self._subscriptions.pop(name))
        for name in sorted(wanted - self._subscriptions.keys()):
            self._subscriptions[name] = self._node.create_subscription(
                PoseStamped, '~/grasps/NAME/target'.replace('NAME', name),
                self._follow(
                    '~/grasps/NAME/target', self._simulation.move_grasp, name,
                    self._inputs.grasp_move), _DEPTH)

    def _follow(
            self, topic: str, move: Move, name: str,
            tell: Tell) -> Callable[[PoseStamped], None]:
        intervals = Intervals()

        def on_message(message: PoseStamped) -> None:
            duration = intervals.before(self._simulation.stepping.edit_time)
            try:
                given = self._frames.given(message.header)
                path = move(
                    name, given.point(message.pose.position),
                    given.orientation(message.pose.orientation), duration=duration)
            except ClothSimError as error:
                self._ignored.note(topic.replace('NAME', name), error)
            else:
                tell(path.move)

        return on_message


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


# Fields that are not set are 0 in ROS: that speed means the usual one.
def _on_request(
        kind: str, move: Move, tell: Tell, frames: InputFrames, request: MoveFrame.Request,
        response: MoveFrame.Response) -> str:
    given = frames.given(request.header)
    x, y, z = target = given.point(request.pose.position)
    path = move(
        request.name, target,
        None if request.keep_orientation else given.orientation(request.pose.orientation),
        request.speed or None, request.angular_speed or None)
    tell(path.move)
    response.arrival = path.arrival
    return (
        f'{kind} {request.name} moves to ({x:g}, {y:g}, {z:g}) and arrives at '
        f'{path.arrival:g} s')
