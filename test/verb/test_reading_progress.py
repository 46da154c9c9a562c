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


"""The progress bar over recordings."""

from cloth_sim_ros.verb.reading_progress import ReadingProgress
import pytest


def test_it_hands_everything_on():
    """Entries would be lost on the way, or come twice."""
    watch = ReadingProgress('bag')
    first, second = watch(iter(range(5)), 5), watch(iter(range(3)), 3)
    assert [next(first), next(second), *first, *second] == [0, 0, 1, 2, 3, 4, 1, 2]


def test_an_error_ends_the_bar(capsys):
    """The reason would stand behind the bar, on its line."""
    def broken():
        yield 1
        raise ValueError

    with pytest.raises(ValueError):
        list(ReadingProgress('bag')(broken(), 2))
    assert capsys.readouterr().err.rpartition('\r')[2] == ''
