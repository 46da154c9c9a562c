# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A node that no callback can end, and that answers every request."""

from collections import deque
from collections.abc import Callable
import inspect
import time
import traceback
from typing import Any
from typing import NamedTuple
import warnings

from cloth_sim_interfaces.msg import ResultCode
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.node.frame_executor import FrameExecutor
from cloth_sim_ros.node.refusals import LogThrottle
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters
from rcl_interfaces.srv import SetParametersAtomically
from rclpy.clock import Clock
from rclpy.clock import ClockType
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import qos_profile_services_default
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.subscription import Subscription
from rclpy.timer import Timer

# The same fault may come with every frame: its trace is logged once in this time [s].
QUIET = 10.0


class Faults:
    """
    Count and log unexpected exceptions.

    :param log: is given each text to log
    """

    def __init__(self, log: Callable[[str], object]) -> None:
        """Begin with none."""
        self._log = log
        self._throttle = LogThrottle(QUIET)
        self.count = 0
        self.latest = ''

    def note(self, error: BaseException, where: str) -> str:
        """
        Count and log ``error``, and return it in one line.

        :param where: what failed, in words
        """
        self.count += 1
        reason = cut(error)
        self.latest = f'{where}: {type(error).__name__}' + (f' ({reason})' if reason else '')
        missed = self._throttle.left_out(f'{where} {type(error).__name__} {_place(error)}')
        if missed is None:
            return self.latest
        repeats = f', and {missed} times since this was last logged' if missed else ''
        trace = ''.join(traceback.format_exception(error))
        self._log(
            f'unexpected error in {self.latest}{repeats}; the node continues: report it with this '
            f'trace\n{trace}')
        return self.latest


def _place(error: BaseException) -> str:
    trace = traceback.extract_tb(error.__traceback__)
    return f'{trace[-1].filename}:{trace[-1].lineno}' if trace else ''


# Answers whose callers the middleware has not discovered yet: sent again until it has.

# The middleware blocks 0.1 s for each attempt that fails, and nothing else is served meanwhile:
# one attempt in this time [s] leaves the node four fifths of its own.
RETRY_PERIOD = 0.5
# Discovery repeats what was lost after 3 s.
PATIENCE = 10.0
_MOST_WAITING = 20


class _Answer(NamedTuple):
    """An answer to send, its service, and until when."""

    name: str
    send: Callable[[Any, Any], None]
    response: Any
    header: Any
    deadline: float


class LateAnswers:
    """
    Send answers, and those that were not delivered again.

    The two halves of a client are discovered one by one. Where the half that asks comes first, a
    quick answer finds nobody to go to; rclpy warns of that, drops the answer, and the caller waits
    for ever.

    :param warn: is given a line for each answer that was given up
    :param wait: asks for a call of ``retry`` every RETRY_PERIOD
    :param rest: ends these calls
    :param clock: wall time [s]
    """

    def __init__(
            self, *, warn: Callable[[str], object], wait: Callable[[], object],
            rest: Callable[[], object], clock: Callable[[], float] = time.monotonic) -> None:
        """Begin with none."""
        self._warn = warn
        self._wait = wait
        self._rest = rest
        self._clock = clock
        self._waiting: deque[_Answer] = deque()

    def send(
            self, name: str, send: Callable[[Any, Any], None], response: Any,
            header: Any) -> None:
        """Answer a request to the service ``name`` by ``send``, with response and header."""
        answer = _Answer(name, send, response, header, self._clock() + PATIENCE)
        if _is_delivered(answer):
            return
        if len(self._waiting) == _MOST_WAITING:
            self._give_up(self._waiting.popleft())
        self._waiting.append(answer)
        self._wait()

    def retry(self) -> None:
        """Send the answer that has waited longest since its last attempt."""
        if self._waiting:
            answer = self._waiting.popleft()
            if not _is_delivered(answer):
                if self._clock() < answer.deadline:
                    self._waiting.append(answer)
                else:
                    self._give_up(answer)
        if not self._waiting:
            self._rest()

    def _give_up(self, answer: _Answer) -> None:
        self._warn(
            f'a request on {answer.name} was carried out, and its answer not delivered: the '
            'middleware has not discovered who receives it; check the QoS of the client, and call '
            'again')


def _is_delivered(answer: _Answer) -> bool:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter('always')
        answer.send(answer.response, answer.header)
    others = [warning for warning in caught if 'failed to send response' not in str(
        warning.message)]
    for warning in others:
        warnings.warn_explicit(
            warning.message, warning.category, warning.filename, warning.lineno)
    return len(others) == len(caught)


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
        :param answer_with: makes the result instead of one that failed, of the reason and what
            ``callback`` was given; None by default
        """
        def note(error: Exception, arguments: tuple[Any, ...]) -> Any:
            # Calls in progress when ROS is shut down fail; that is no error.
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
        executor = FrameExecutor(self)
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
    if hasattr(response, 'code'):
        response.code = ResultCode.UNEXPECTED
    refused = SetParametersResult(successful=False, reason=text)
    if isinstance(response, SetParameters.Response):
        response.results = [refused] * len(request.parameters)
    if isinstance(response, SetParametersAtomically.Response):
        response.result = refused
    # The other services of rclpy have no field for it: an empty answer is their own way.
    return response


def _name(callback: Callable[..., Any]) -> str:
    return getattr(callback, '__qualname__', type(callback).__name__)
