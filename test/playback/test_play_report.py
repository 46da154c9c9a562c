# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
