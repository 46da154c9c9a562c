# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Grasps and colliders that are moved from outside, by services and by streams of poses."""

from collections.abc import Callable
from functools import partial

from cloth_sim_interfaces.srv import MoveFrame
from cloth_sim_ros.node.answer import answer
from cloth_sim_ros.node.ignored_messages import IgnoredMessages
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.frame_paths import FramePath
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import PoseStamped
from rclpy.node import Node
from rclpy.subscription import Subscription

# A controller at 1 kHz fills it in the time of a few frames.
_DEPTH = 100
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
