# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pushes and wind from outside: services, ~/push, ~/wind, and clicks in a viewer."""

from collections.abc import Mapping
from typing import Any

from cloth_sim_interfaces.msg import Push as PushMessage
from cloth_sim_interfaces.srv import ApplyPush
from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.input_frames import InputFrames
from cloth_sim_ros.node.on_device import listen_on_device
from cloth_sim_ros.node.on_device import serve_on_device
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.sim.simulation import Simulation
from geometry_msgs.msg import PointStamped
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Vector3Stamped
from rclpy.node import Node
from std_srvs.srv import Trigger

_PUSH_DEPTH = 10
# A sensor or a model of the wind at 1 kHz fills it in the time of a few frames.
_WIND_DEPTH = 100


class LoadRequests:
    """
    Serve ~/apply_push and ~/clear_pushes, listen to ~/push, ~/wind and /clicked_point.

    :param values: the node's parameter values, read at each click
    :param frames: says what headers mean
    :param ignored: is given the messages that make no sense
    """

    def __init__(
            self, node: Node, device: DeviceThread, simulation: Simulation,
            values: Mapping[str, Any], frames: InputFrames, ignored: IgnoredMessages) -> None:
        """Make the services and subscriptions."""
        self._simulation = simulation
        self._values = values
        self._frames = frames
        serve_on_device(node, device, ApplyPush, '~/apply_push', self._apply)
        serve_on_device(node, device, Trigger, '~/clear_pushes', self._clear)
        for kind, topic, depth, carry_out in (
                (PushMessage, '~/push', _PUSH_DEPTH, self._on_push),
                (PointStamped, '/clicked_point', _PUSH_DEPTH, self._on_click),
                (Vector3Stamped, '~/wind', _WIND_DEPTH, self._on_wind)):
            listen_on_device(node, device, kind, topic, depth, carry_out, ignored)

    def _apply(self, request: ApplyPush.Request, response: ApplyPush.Response) -> str:
        given = self._frames.given(request.header)
        applied = self._simulation.push(
            given.vector(request.force), region=request.region or PushMessage.ALL,
            center=given.point(request.center), radius=request.radius,
            duration=request.duration)
        response.nodes = applied.nodes
        x, y, z = applied.impulse
        response.impulse = Vector3(x=x, y=y, z=z)
        return f'pushing {applied.nodes} nodes for {request.duration:g} s'

    def _clear(self, _: Trigger.Request, __: Trigger.Response) -> str:
        return f'{self._simulation.clear_pushes()} pushes cleared'

    def _on_push(self, message: PushMessage) -> None:
        given = self._frames.given(message.header)
        self._simulation.push(
            given.vector(message.force), region=message.region or PushMessage.ALL,
            center=given.point(message.center), radius=message.radius,
            duration=message.duration, start=message.start or None)

    def _on_click(self, message: PointStamped) -> None:
        center = self._frames.given(message.header).point(message.point)
        self._simulation.push(
            self._values['clicked_point.force'], region=PushMessage.SPHERE, center=center,
            radius=self._values['clicked_point.radius'],
            duration=self._values['clicked_point.duration'])

    def _on_wind(self, message: Vector3Stamped) -> None:
        """Have the wind blow until the next message."""
        self._simulation.set_wind(self._frames.given(message.header).vector(message.vector))
