# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A node that no callback can end, and that answers every request."""

from collections.abc import Callable
import inspect
from typing import Any

from cloth_sim_ros.node.faults import Faults
from cloth_sim_ros.node.late_answers import LateAnswers
from cloth_sim_ros.node.late_answers import RETRY_PERIOD
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.executors import ExternalShutdownException
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import qos_profile_services_default
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Timer

# Requests that wait, and answers under way, of one service: beyond it the middleware drops them
# without a word, and by default from 10 on.
SERVICE_DEPTH = 1000
SERVICE_QUALITY = QoSProfile(
    depth=SERVICE_DEPTH, history=qos_profile_services_default.history,
    reliability=qos_profile_services_default.reliability,
    durability=qos_profile_services_default.durability)
# In a row: an executor that fails so often can do no work any more.
_MOST_FAILURES = 100


class GuardedNode(Node):
    """
    A node whose callbacks may fail.

    rclpy ends spin() with the first exception of a callback, and the request that it served is
    never answered. Here it is noted in ``faults``, and the request is answered with the reason.
    That holds for the services of rclpy as well, which are made by the same methods.

    :ivar faults: what went wrong
    :ivar fatal: set it to end ``spin`` with this exception
    """

    def __init__(self, name: str) -> None:
        """Begin without a fault."""
        self.faults = Faults(lambda text: self.get_logger().error(text))
        self.fatal: Exception | None = None
        self._retries: Timer | None = None
        self._late_answers = LateAnswers(
            warn=lambda text: self.get_logger().warning(text), wait=self._begin_retries,
            rest=lambda: self._retries.cancel() if self._retries is not None else None)
        super().__init__(name)

    def create_service(
            self, srv_type: type, srv_name: str, callback: Callable[[Any, Any], Any], *,
            qos_profile: QoSProfile = SERVICE_QUALITY, **options: Any) -> Service:
        """Serve ``callback``; a fault in it is the answer, and that is sent until it arrives."""
        service = super().create_service(
            srv_type, srv_name, self.guarded(callback, srv_name, _answer_with),
            qos_profile=qos_profile, **options)
        send = service.send_response
        # What the executor calls with the result of the callback.
        service.send_response = (  # type: ignore[method-assign]
            lambda response, header: self._late_answers.send(srv_name, send, response, header))
        return service

    def create_subscription(
            self, msg_type: type, topic: str, callback: Callable[[Any], None],
            *arguments: Any, **options: Any) -> Subscription:
        """Listen to ``topic``."""
        return super().create_subscription(
            msg_type, topic, self.guarded(callback, topic), *arguments, **options)

    def create_timer(
            self, timer_period_sec: float, callback: Callable[[], None],
            *arguments: Any, **options: Any) -> Timer:
        """Call ``callback`` again and again."""
        return super().create_timer(
            timer_period_sec, self.guarded(callback, _name(callback)), *arguments, **options)

    def create_guard_condition(
            self, callback: Callable[[], None], *arguments: Any, **options: Any) -> Any:
        """Call ``callback`` when triggered."""
        return super().create_guard_condition(
            self.guarded(callback, _name(callback)), *arguments, **options)

    def guarded(
            self, callback: Callable[..., Any], where: str,
            answer_with: Callable[..., Any] | None = None) -> Callable[..., Any]:
        """
        Return ``callback`` without its exceptions.

        :param where: what it serves, for the log
        :param answer_with: makes the result in place of one that failed, of the reason and what
            ``callback`` was given; None by default
        """
        def note(error: Exception, arguments: tuple[Any, ...]) -> Any:
            # What is under way when ROS is shut down fails, and that is nobody's fault.
            if not self.context.ok():
                raise error
            reason = self.faults.note(error, where)
            return answer_with(reason, *arguments) if answer_with is not None else None

        def call(*arguments: Any) -> Any:
            try:
                return callback(*arguments)
            except Exception as error:
                return note(error, arguments)

        async def wait_for(*arguments: Any) -> Any:
            try:
                return await callback(*arguments)
            except Exception as error:
                return note(error, arguments)

        return wait_for if inspect.iscoroutinefunction(callback) else call

    def _begin_retries(self) -> None:
        if self._retries is None:
            # Simulated time may stand still.
            self._retries = self.create_timer(
                RETRY_PERIOD, self._late_answers.retry,
                clock=Clock(clock_type=ClockType.STEADY_TIME))
        elif self._retries.is_canceled():
            self._retries.reset()

    def spin(self) -> None:
        """
        Serve until ROS is shut down, or ``fatal`` is set.

        :raises Exception: ``fatal``, or what the executor fails with again and again
        """
        executor = SingleThreadedExecutor(context=self.context)
        executor.add_node(self)
        failures = 0
        while self.context.ok() and self.fatal is None:
            try:
                executor.spin_once()
                failures = 0
            except ExternalShutdownException:
                return
            except Exception as error:
                # Not of a callback: a request or a message that cannot be read, for instance.
                failures += 1
                if failures > _MOST_FAILURES or not self.context.ok():
                    raise
                self.faults.note(error, 'the executor')
        if self.fatal is not None:
            raise self.fatal


def _answer_with(reason: str, request: Any, response: Any) -> Any:
    """Return the answer to a request that failed unexpectedly."""
    text = (
        f'an unexpected error aborted the request, {reason}: report it with the trace from the '
        'log, and call ~/reset if the cloth is in a wrong state')
    if hasattr(response, 'success'):
        response.success, response.message = False, text
    refused = SetParametersResult(successful=False, reason=text)
    if isinstance(response, SetParameters.Response):
        response.results = [refused] * len(request.parameters)
    if isinstance(response, SetParametersAtomically.Response):
        response.result = refused
    # The other services of rclpy have no field for it: an empty answer is their own way.
    return response


def _name(callback: Callable[..., Any]) -> str:
    return getattr(callback, '__qualname__', type(callback).__name__)
