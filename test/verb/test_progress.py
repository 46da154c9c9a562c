# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The progress bar over recordings."""

from cloth_sim_ros.verb.progress import ReadingProgress
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
