# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Answers whose callers the middleware has not discovered yet: sent again until it has."""

from collections import deque
from collections.abc import Callable
import time
from typing import Any
from typing import NamedTuple
import warnings

# The middleware blocks 0.1 s for each attempt that fails, and nothing else is served meanwhile:
# one attempt in this time [s] leaves the node four fifths of its own.
RETRY_PERIOD = 0.5
# Discovery repeats what was lost after 3 s.
PATIENCE = 10.0
_MOST_WAITING = 20


class _Answer(NamedTuple):
    """What is to be sent, by which service, and until when."""

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
        """Send ``response`` by ``send(response, header)`` of the service ``name``."""
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
