# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pushes and wind from outside: services, ~/push, ~/wind, and clicks in a viewer."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.outlet import Inputs
from cloth_sim_ros.node.refusals import answer
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.push_field import AppliedPush
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import PointStamped
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Vector3Stamped
from rclpy.node import Node
from std_srvs.srv import Trigger

_PUSH_DEPTH = 10


class PushRequests:
    """
    Serve ~/apply_push and ~/clear_pushes, listen to ~/push and /clicked_point.

    :param values: the node's parameter values, read at each click
    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs,
            values: Mapping[str, Any], frames: InputFrames, ignored: IgnoredMessages) -> None:
        """Make the services and subscriptions."""
        self._ignored = ignored
        self._simulation = simulation
        self._inputs = inputs
        self._values = values
        self._frames = frames
        node.create_service(ApplyPush, '~/apply_push', answer(self._apply))
        node.create_service(Trigger, '~/clear_pushes', answer(self._clear))
        node.create_subscription(Push, '~/push', self._on_push, _PUSH_DEPTH)
        node.create_subscription(PointStamped, '/clicked_point', self._on_click, _PUSH_DEPTH)

    def _apply(self, request: ApplyPush.Request, response: ApplyPush.Response) -> str:
        given = self._frames.given(request.header)
        applied = self._push(
            force=given.vector(request.force), region=request.region or Push.ALL,
            center=given.point(request.center), radius=request.radius,
            duration=request.duration)
        response.nodes = applied.nodes
        x, y, z = applied.impulse
        response.impulse = Vector3(x=x, y=y, z=z)
        return f'pushing {applied.nodes} nodes for {request.duration:g} s'

    def _clear(self, _: Trigger.Request, __: Trigger.Response) -> str:
        self._inputs.command(Command.CLEAR_PUSHES)
        return f'{self._simulation.clear_pushes()} pushes cleared'

    def _on_push(self, message: Push) -> None:
        try:
            given = self._frames.given(message.header)
            self._push(
                force=given.vector(message.force), region=message.region or Push.ALL,
                center=given.point(message.center), radius=message.radius,
                duration=message.duration, start=message.start or None)
        except ClothSimError as error:
            self._ignored.note('~/push', error)

    def _on_click(self, message: PointStamped) -> None:
        try:
            center = self._frames.given(message.header).point(message.point)
            self._push(
                force=self._values['clicked_point.force'], region=Push.SPHERE, center=center,
                radius=self._values['clicked_point.radius'],
                duration=self._values['clicked_point.duration'])
        except ClothSimError as error:
            self._ignored.note('/clicked_point', error)

    def _push(self, **request: Any) -> AppliedPush:
        applied = self._simulation.push(**request)
        self._inputs.push(applied.push)
        return applied


# The wind, as a topic: ~/wind.

# A sensor or a model of the wind at 1 kHz fills it in the time of a few frames.
_WIND_DEPTH = 100


class WindTopic:
    """
    Listen to ~/wind: each message blows until the next one, from the end of the step under way.

    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, simulation: Simulation, inputs: Inputs, frames: InputFrames,
            ignored: IgnoredMessages) -> None:
        """Make the subscription."""
        self._simulation = simulation
        self._inputs = inputs
        self._frames = frames
        self._ignored = ignored
        node.create_subscription(Vector3Stamped, '~/wind', self._on_message, _WIND_DEPTH)

    def _on_message(self, message: Vector3Stamped) -> None:
        try:
            velocity = self._frames.given(message.header).vector(message.vector)
            self._simulation.set_wind(velocity)
            self._inputs.wind(velocity)
        except ClothSimError as error:
            self._ignored.note('~/wind', error)
