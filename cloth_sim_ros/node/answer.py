# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Turn a request that cannot be carried out into an answer that says why."""

from collections.abc import Awaitable
from collections.abc import Callable
import os
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node


def answer(carry_out: Callable[[Any, Any], str]) -> Callable[[Any, Any], Any]:
    """
    Return a service callback around ``carry_out(request, response) -> message``.

    A ClothSimError becomes success false with its reason; every service of the node has the
    response fields success and message.
    """
    def callback(request: Any, response: Any) -> Any:
        try:
            return _done(response, carry_out(request, response))
        except ClothSimError as error:
            return _refused(response, error)

    return callback


def serve_later(
        node: Node, kind: type, name: str,
        carry_out: Callable[[Any, Any], Awaitable[str]]) -> None:
    """Serve requests by a coroutine; while one waits, everything else is served."""
    async def callback(request: Any, response: Any) -> Any:
        try:
            return _done(response, await carry_out(request, response))
        except ClothSimError as error:
            return _refused(response, error)

    # In the group of all others a request that waits would hold them up.
    node.create_service(kind, name, callback, callback_group=ReentrantCallbackGroup())


def _done(response: Any, message: str) -> Any:
    response.success, response.message = True, message
    return response


def _refused(response: Any, error: ClothSimError) -> Any:
    response.success, response.message = False, str(error)
    return response


def ros_reason(error: Exception) -> str:
    """Return what ROS says in ``error``, without the line of its source."""
    text = str(error).partition(', at /')[0].removeprefix('failed to initialize rcl: ')
    return cut(' '.join(text.split()))


def is_about_security(error: Exception) -> bool:
    """Tell whether ROS lacks what a secured graph needs."""
    return 'SECURITY' in str(error).upper()


def no_node(error: Exception) -> ClothSimError:
    """Return the error to raise where ROS makes no node."""
    if os.environ.get('ROS_SECURITY_ENABLE', '').lower() == 'true':
        way_out = (
            'use a ROS built with security and name an enclave of ROS_SECURITY_KEYSTORE, with '
            '--ros-args --enclave or ROS_SECURITY_ENCLAVE_OVERRIDE, or unset ROS_SECURITY_ENABLE')
    else:
        way_out = 'check the ROS_ and RMW_ variables of the environment'
    return ClothSimError(f'ROS cannot create a node: {ros_reason(error)}; {way_out}')
