# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the player says at its end."""

from cloth_sim_ros.playback.play_report import PlayReport


def test_all_in_time_is_one_sentence():
    """A user would look for a problem that there is not."""
    assert PlayReport(messages=7, rounds=1, furthest_behind=0.004).sentences() == [
        'played 7 messages, in time']


def test_lateness_is_told():
    """What looked jerky would be taken for the recording."""
    told, problem = PlayReport(
        messages=7, rounds=3, furthest_behind=60.0, slipped=59.5).sentences()
    assert told == 'played 7 messages in 3 rounds, at most 60 s late'
    assert 'this took 60 s longer' in problem
    assert 'nothing was dropped' in problem


def test_messages_that_a_reader_may_lack_are_told():
    """A recording of what was played would have gaps, and nobody would know."""
    _, problem = PlayReport(messages=7, rounds=1, overruns={'/a/points': 3}).sentences()
    assert 'a subscriber of /a/points may have lost up to 3 messages' in problem
