# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pins that are held, let go and moved from outside: ~/set_pin, ~/move_pin and ~/pins/target."""

from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.srv import MovePin
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.node.answer import answer
from cloth_sim_ros.node.ignored_messages import IgnoredMessages
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.inputs import Inputs
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.pins import PinPath
from cloth_sim_ros.sim.pose import Vector
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.node import Node

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
