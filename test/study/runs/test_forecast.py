# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A forecast follows from the runs that have ended."""

from cloth_sim_ros.study.runs.forecast import Forecast
from cloth_sim_ros.study.runs.forecast import in_minutes
from cloth_sim_ros.study.runs.result import DONE
from cloth_sim_ros.study.runs.result import unmade
from cloth_sim_ros.study.runs.run import Run
import pytest

SMALL = {'rows': 10, 'cols': 10}
LARGE = {'rows': 20, 'cols': 20}


def ended(run: Run, seconds: float):
    """Return the result of a run that took ``seconds``."""
    return unmade(run, DONE, '', wall_seconds=seconds)


def test_larger_runs_of_a_kind_are_expected_to_take_longer():
    """A study that begins with its largest runs would seem to take several times as long."""
    first, second = Run('m:f', LARGE, {'n': 1}), Run('m:f', SMALL, {'n': 2})
    forecast = Forecast([first, second])
    assert forecast.seconds_left(0.0) is None
    forecast.end(ended(first, 8.0))
    assert forecast.seconds_left(8.0) == pytest.approx(8.0 * 100 / 400)
    forecast.end(ended(second, 2.0))
    assert forecast.seconds_left(10.0) == 0.0


def test_each_mode_has_its_own_speed():
    """A slow mode at the end would come as a surprise."""
    runs = [Run('m:f', {**SMALL, 'mode': mode}, {'n': n})
            for n in range(2) for mode in ('mass_spring', 'constraint')]
    forecast = Forecast(runs)
    forecast.end(ended(runs[0], 1.0))
    assert forecast.seconds_left(1.0) == pytest.approx(3.0)
    forecast.end(ended(runs[1], 9.0))
    assert forecast.seconds_left(10.0) == pytest.approx(1.0 + 9.0)


def test_runs_side_by_side_take_less():
    """The forecast would be that of one process, however many make runs."""
    runs = [Run('m:f', SMALL, {'n': n}) for n in range(6)]
    forecast = Forecast(runs)
    for run in runs[:4]:
        forecast.end(ended(run, 10.0))
    # Two at a time: 4 runs of 10 s in 20 s.
    assert forecast.seconds_left(20.0) == pytest.approx(10.0)


@pytest.mark.parametrize(('seconds', 'told'), [
    (0.2, 'about 10 s'), (44.0, 'about 40 s'), (100.0, 'about 2 min'), (7300.0, 'about 2.0 h')])
def test_a_forecast_is_told_as_exactly_as_it_is_known(seconds: float, told: str):
    """Seconds would be counted of a guess."""
    assert in_minutes(seconds) == told
