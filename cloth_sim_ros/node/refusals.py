# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Refused requests: a service responds with the reason, a topic logs it."""

from collections.abc import Awaitable
from collections.abc import Callable
import os
import time
from typing import Any

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.node.result_codes import code_of
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node


def serve_later(
        node: Node, kind: type, name: str,
        carry_out: Callable[[Any, Any], Awaitable[str]]) -> None:
    """
    Serve requests by the coroutine ``carry_out(request, response) -> message``.

    A ClothSimError becomes success false with its reason; every service of the node has the
    response fields success and message. While one waits, everything else is served.
    """
    async def callback(request: Any, response: Any) -> Any:
        try:
            return _done(response, await carry_out(request, response))
        except ClothSimError as error:
            return _refused(response, error)

    # In the group of all others a request that waits would hold them up.
    node.create_service(kind, name, callback, callback_group=ReentrantCallbackGroup())


def _done(response: Any, message: str) -> Any:
    response.success, response.message = True, message
    if hasattr(response, 'code'):
        response.code = ResultCode.OK
    return response


def _refused(response: Any, error: ClothSimError) -> Any:
    response.success, response.message = False, str(error)
    # Services of std_srvs have none.
    if hasattr(response, 'code'):
        response.code = code_of(error)
    return response


def ros_reason(error: Exception) -> str:
    """Return what ROS says in ``error``, without the line of its source."""
    text = str(error).partition(', at /')[0].removeprefix('failed to initialize rcl: ')
    return cut(' '.join(text.split()))


def is_about_security(error: Exception) -> bool:
    """Return whether ROS lacks what a secured graph needs."""
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


# Messages that ask for what cannot be: topics have no answer, so the log has them.

_MOST_KINDS = 100
QUIET = 1.0  # [s] of wall time between two warnings of one topic


class LogThrottle:
    """
    Decide what to log of things of many kinds.

    :param quiet: time between two lines of the same kind [s]
    :param clock: wall time [s]
    """

    def __init__(self, quiet: float, clock: Callable[[], float] = time.monotonic) -> None:
        """Begin with nothing logged."""
        self._quiet = quiet
        self._clock = clock
        # By kind: the time of the last line [s], and the number left out since.
        self._logged: dict[str, tuple[float, int]] = {}

    def left_out(self, kind: str) -> int | None:
        """
        Return how many of this kind were left out since one was logged.

        None when this one is to be left out as well.
        """
        now = self._clock()
        logged, missed = self._logged.get(kind, (-self._quiet, 0))
        if now - logged < self._quiet:
            self._logged[kind] = logged, missed + 1
            return None
        if len(self._logged) >= _MOST_KINDS:
            self._logged.clear()
        self._logged[kind] = now, 0
        return missed


class IgnoredMessages:
    """
    Count the messages that are ignored, and warn of them, but not of each in a flood.

    :param warn: is given each warning
    """

    def __init__(self, warn: Callable[[str], object]) -> None:
        """Begin with none."""
        self._warn = warn
        self._throttle = LogThrottle(QUIET)
        self.count = 0

    def note(self, topic: str, error: Exception) -> None:
        """Count a message on ``topic`` that is ignored because of ``error``."""
        self.count += 1
        missed = self._throttle.left_out(topic)
        if missed is None:
            return
        others = f'; {missed} others since the last warning' if missed else ''
        self._warn(f'a message on {topic} is ignored: {error}{others}')
