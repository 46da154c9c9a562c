# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is logged of things that come often."""

from cloth_sim_ros.node.log_throttle import LogThrottle


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
