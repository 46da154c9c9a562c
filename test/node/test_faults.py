# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Counting and logging what nobody foresaw."""

from cloth_sim_ros.node.faults import Faults


def fault():
    """Return an exception with a trace."""
    try:
        raise KeyError('no such\nname')
    except KeyError as error:
        return error


def test_a_fault_is_counted_and_logged_with_its_trace():
    """A fault could not be reported, for want of the place it comes from."""
    logged = []
    faults = Faults(logged.append)
    line = faults.note(fault(), '~/reset')
    assert faults.count == 1
    assert line == faults.latest and line.startswith('~/reset: KeyError') and '\n' not in line
    assert 'raise KeyError' in logged[0] and 'the node continues' in logged[0]


def test_a_fault_of_every_frame_does_not_fill_the_disk():
    """A fault that comes 50 times a second would write a trace each time."""
    logged = []
    faults = Faults(logged.append)
    for _ in range(500):
        faults.note(fault(), 'a frame')
    faults.note(fault(), 'a step')
    assert len(logged) == 2 and faults.count == 501
