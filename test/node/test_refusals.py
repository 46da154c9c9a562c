# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What cannot be carried out: a service answers why, and of a topic the log has it."""

from types import SimpleNamespace

from cloth_sim_ros.node.refusals import answer
from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.refusals import LogThrottle
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


def test_tells_what_was_done():
    """A request that was carried out would not be answered with success."""
    callback = answer(lambda request, response: f'did {request}')
    response = callback('this', SimpleNamespace())
    assert (response.success, response.message) == (True, 'did this')


def test_tells_why_not():
    """A refused request would end the node, or be answered without the reason."""
    def refuse(request, response):
        raise ClothSimError('too much: take less')

    response = answer(refuse)(None, SimpleNamespace())
    assert (response.success, response.message) == (False, 'too much: take less')


def test_lets_faults_of_the_program_through():
    """A fault of the program would look like a mistake of the user."""
    def fail(request, response):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        answer(fail)(None, SimpleNamespace())


# Warnings of messages that make no sense.


def test_one_of_a_kind_is_logged_now_and_then():
    """A client at 1 kHz would fill the disk, or what was left out would go uncounted."""
    now = [0.0]
    throttle = LogThrottle(10.0, clock=lambda: now[0])
    assert throttle.left_out('push') == 0
    assert [throttle.left_out('push') for _ in range(99)] == [None] * 99
    assert throttle.left_out('pin') == 0, 'another kind has its own time'
    now[0] = 10.0
    assert throttle.left_out('push') == 99
    now[0] = 20.0
    assert throttle.left_out('push') == 0


def test_kinds_without_end_take_no_memory_without_end():
    """A client could have each of its messages be of another kind."""
    throttle = LogThrottle(10.0, clock=lambda: 0.0)
    assert all(throttle.left_out(str(kind)) == 0 for kind in range(1000))
    assert len(throttle._logged) <= 100


def test_a_flood_does_not_fill_the_log():
    """A client at 1 kHz would write a line a millisecond, or its messages vanish uncounted."""
    warnings = []
    ignored = IgnoredMessages(warnings.append)
    for _ in range(100):
        ignored.note('~/push', ValueError('too much: take less'))
    ignored.note('~/pins/target', ValueError('no pin: pin it'))
    assert warnings == [
        'a message on ~/push is ignored: too much: take less',
        'a message on ~/pins/target is ignored: no pin: pin it']
    assert ignored.count == 101
