# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Warnings of messages that make no sense."""

from cloth_sim_ros.node.refusals import IgnoredMessages
from cloth_sim_ros.node.refusals import LogThrottle


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
