# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How often the log says that a run is too slow."""

from collections.abc import Callable

from cloth_sim_ros.node.pace_report import PaceReport
from cloth_sim_ros.node.pace_report import QUIET
from cloth_sim_ros.node.pace_report import STEADY
from cloth_sim_ros.node.pacing import Pacing
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest

_FRAME = 0.02
Log = list[tuple[float, str, str]]


@pytest.fixture
def run() -> Callable[..., Log]:
    """
    Return a function that runs frames, and returns when the log got what.

    It takes spans of wall time [s], each with the pace of its frames.
    """
    simulation = Simulation(Scene({'rows': 8, 'cols': 8}))
    assert simulation.substeps > 1

    def make(*spans: tuple[float, float]) -> Log:
        log: Log = []
        now = 0.0
        pacing = Pacing(1.0)
        report = PaceReport(
            simulation, pacing, warn=lambda text: log.append((now, 'warning', text)),
            say=lambda text: log.append((now, 'info', text)))
        pacing.restart(now)
        for length, pace in spans:
            end = now + length
            while now < end:
                now += _FRAME / pace
                pacing.delay(now, _FRAME)
                report.look(now)
        return log

    yield make
    simulation.close()


def test_a_slow_run_is_warned_of_once(run):
    """The log of a slow machine would fill with one and the same line."""
    (time, level, text), = run((600.0, 0.5))
    assert level == 'warning' and time < 2.0
    assert text == (
        '0.5 x real time, below the target 1: use fewer nodes, softer springs, another mode or a '
        'lower real_time_factor')


def test_a_run_that_keeps_up_again_says_so(run):
    """Nobody would know whether what was changed has helped."""
    _, (time, level, text) = run((20.0, 0.5), (60.0, 1.0))
    assert level == 'info' and 20.0 + STEADY < time < 20.0 + STEADY + 3.0
    assert text == '1 x real time: the run keeps up again'


def test_a_run_that_comes_and_goes_is_warned_of_once_a_minute(run):
    """Two lines would come every few seconds."""
    log = run(*[(10.0, 0.5), (10.0, 1.0)] * 30)
    warnings = [time for time, level, _ in log if level == 'warning']
    assert 5 <= len(warnings) <= 600.0 / QUIET + 1
    assert min(after - before for before, after in zip(warnings, warnings[1:])) >= QUIET
    assert len(log) <= 2 * len(warnings)


def test_a_short_halt_is_not_told(run):
    """A garbage collection would look like a machine that is too slow."""
    assert run((10.0, 1.0), (0.05, 0.4), (20.0, 1.0)) == []
