# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Requests and messages that are carried out on the device thread, between two steps of dt."""

from collections import deque
from collections.abc import Callable
from typing import Any

from cloth_sim_ros.node.device_thread import DeviceThread
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.refusals import serve_later
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.node import Node
from rclpy.subscription import Subscription


def serve_on_device(
        node: Node, device: DeviceThread, kind: type, name: str,
        carry_out: Callable[[Any, Any], str]) -> None:
    """
    Serve requests by ``carry_out(request, response) -> message``.

    A ClothSimError becomes success false with its reason; every service of the node has the
    response fields success and message.
    """
    async def wait_for(request: Any, response: Any) -> str:
        message: str = await device.ask(lambda: carry_out(request, response))
        return message

    serve_later(node, kind, name, wait_for)


def listen_on_device(
        node: Node, device: DeviceThread, kind: type, topic: str, depth: int,
        carry_out: Callable[[Any], object], ignored: IgnoredMessages) -> Subscription:
    """
    Subscribe to ``topic``, and have ``carry_out`` called with each message.

    :param depth: messages that may wait for the end of a step; the oldest are dropped
    :param ignored: is given those that make no sense
    """
    waiting: deque[Any] = deque(maxlen=depth)

    def take_one() -> None:
        # The job of a message that was dropped finds none.
        if not waiting:
            return
        try:
            carry_out(waiting.popleft())
        except ClothSimError as error:
            ignored.note(topic, error)
        except Exception as error:
            device.note(error, topic)

    def on_message(message: Any) -> None:
        waiting.append(message)
        device.post(take_one)

    return node.create_subscription(kind, topic, on_message, depth)
