# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Parts of a bag, by time."""

from pathlib import Path

from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from copied_bag import copy_bag
import pytest


@pytest.fixture(params=['as recorded', 'cut off', 'sqlite3', 'split'])
def bag(request, recorded, tmp_path):
    """Return the same bag in several forms."""
    if request.param == 'as recorded':
        return BagReader(recorded)
    if request.param == 'cut off':
        file, = Path(recorded).glob('*.mcap')
        cut = tmp_path / 'cut.mcap'
        cut.write_bytes(file.read_bytes()[:-500])
        return BagReader(cut)
    if request.param == 'sqlite3':
        return BagReader(copy_bag(recorded, tmp_path / 'copy', 'sqlite3'))
    return BagReader(copy_bag(recorded, tmp_path / 'copy', split=3))


def test_the_span_is_from_the_first_to_the_last_message(bag):
    """Playing would begin or end at another time than the messages."""
    times = [message.time for message in bag.messages()]
    assert len(times) > 30
    assert bag.span == (min(times), max(times))


@pytest.mark.parametrize('names', [None, {'/cloth_sim/stats'}])
def test_a_part_is_what_lies_between_its_times(names, bag):
    """A late start would have messages from before, or lack some."""
    first, last = bag.span
    begin, end = first + (last - first) // 3, first + (last - first) // 2
    whole = list(bag.messages(names))
    assert list(bag.messages(names, begin=begin)) == [
        message for message in whole if message.time >= begin]
    assert list(bag.messages(names, end=end)) == [
        message for message in whole if message.time < end]
    between = list(bag.messages(names, begin=begin, end=end))
    assert between == [message for message in whole if begin <= message.time < end]
    assert between


def test_an_empty_bag_has_no_span(tmp_path):
    """A recording that was only begun would seem to be from 1970."""
    Recorder(tmp_path, 'run').close()
    with pytest.raises(ClothSimError, match='contains no messages'):
        assert BagReader(tmp_path / 'run').span
