# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frames compared."""

from cloth_sim_ros.resimulation.frame_check import FrameCheck
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import numpy as np
import pytest


@pytest.fixture
def records():
    """Return a frame of 3 x 4 nodes."""
    made = np.zeros((3, 4), POINT_DTYPE)
    made['x'] = np.arange(12).reshape(3, 4)
    return made


def test_equal_frames_are_counted(records):
    """Frames with the same bits would count as different, NaN first of all."""
    records['strain'][0, 0] = np.nan
    check = FrameCheck()
    for frame in range(3):
        check.compare(0.02 * frame, records.copy(), records)
    assert (check.frames, check.equal, check.first, check.largest) == (3, 3, None, None)


def test_tells_where_and_by_how_much(records):
    """A user would look at the wrong node, or take a last bit for a metre."""
    check = FrameCheck()
    check.compare(0.0, records, records)
    for time, away in ((0.02, 3.0), (0.04, 5.0), (0.06, 1.0)):
        other = records.copy()
        other['y'][2, 1] += away
        other['z'][2, 1] += 4.0
        other['x'][0, 3] += 0.5
        check.compare(time, other, records)
    assert (check.frames, check.equal) == (4, 1)
    assert (check.first.frame, check.first.time, check.first.node) == (2, 0.02, (2, 1))
    assert check.first.distance == 5.0
    assert check.first.fields == ('x', 'y', 'z')
    assert (check.largest.time, check.largest.distance) == (0.04, np.sqrt(41.0))
    assert check.last_rms == pytest.approx(np.sqrt((17.0 + 0.25) / 12))


@pytest.mark.parametrize(('name', 'value'), [('flags', 4), ('vx', -0.0), ('strain', 1e-45)])
def test_sees_every_bit_of_every_field(records, name, value):
    """Runs would be called equal that are not."""
    other = records.copy()
    other[name][1, 2] = value
    check = FrameCheck()
    check.compare(0.1, other, records)
    assert check.equal == 0
    assert (check.first.node, check.first.distance, check.first.fields) == ((1, 2), 0.0, (name,))


def test_other_point_layouts_are_compared_by_value(records):
    """Points of another version, or of the other byte order, would be no frame of this cloth."""
    kinds = [(name, POINT_DTYPE[name].newbyteorder('>')) for name in POINT_DTYPE.names
             if name != 'strain']
    other = np.zeros((3, 4), [('more', 'u1'), *kinds])
    for name, _ in kinds:
        other[name] = records[name]
    check = FrameCheck()
    check.compare(0.0, other, records)
    assert (check.equal, check.missing_fields) == (1, ('strain',))


def test_flags_that_can_not_be_known_do_not_count(records):
    """A run that starts from a recording would differ in the contact flags of its first frame."""
    other = records.copy()
    other['flags'][1, 2] = 8 | 1
    records['flags'][1, 2] = 1
    check = FrameCheck()
    check.compare(0.0, other, records, unknown_flags=8)
    assert check.equal == 1 and other['flags'][1, 2] == 9
    records['flags'][1, 2] = 0
    check.compare(0.1, other, records, unknown_flags=8)
    assert check.first.fields == ('flags',)
