# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long the node waits between frames."""

from collections.abc import Callable

from cloth_sim_ros.node.pacing import PaceReport
from cloth_sim_ros.node.pacing import Pacing
from cloth_sim_ros.node.pacing import QUIET
from cloth_sim_ros.node.pacing import STEADY
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import pytest

_FRAME = 0.02
Log = list[tuple[float, str, str]]


def test_waits_for_the_rest_of_a_frame():
    """A node that took 5 ms for a frame of 20 ms would not run at real time."""
    pacing = Pacing(1.0)
    pacing.restart(100.0)
    assert pacing.delay(100.005, 0.02) == pytest.approx(0.015)


@pytest.mark.parametrize('factor, wait', [(2.0, 0.01), (0.5, 0.04)])
def test_keeps_to_the_factor(factor, wait):
    """Twice real time would not halve the wait, or half real time not double it."""
    pacing = Pacing(factor)
    pacing.restart(0.0)
    assert pacing.delay(0.0, 0.02) == pytest.approx(wait)


def test_factor_0_never_waits():
    """As fast as possible would still be paced."""
    pacing = Pacing(0.0)
    pacing.restart(0.0)
    assert [pacing.delay(0.001 * i, 0.02) for i in range(5)] == [0.0] * 5


def test_catches_up_after_a_late_frame():
    """One late frame would make the whole run late."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    assert pacing.delay(0.05, 0.02) == 0.0
    assert pacing.delay(0.051, 0.02) == 0.0
    assert pacing.delay(0.052, 0.02) == pytest.approx(0.008)


def test_gives_up_what_is_too_late_to_catch_up_with():
    """After a long halt the node would run without a pause for as long again."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    pacing.delay(10.0, 0.02)
    waits = [pacing.delay(10.0, 0.02) for _ in range(20)]
    assert waits[0] == 0.0
    assert waits[-1] > 0.0


def test_measures_the_factor_achieved():
    """The factor in ~/stats would not be simulated time over wall time."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    assert pacing.achieved == 0.0
    for frame in range(1, 201):
        pacing.delay(0.04 * frame, 0.02)
    assert pacing.achieved == pytest.approx(0.5)


@pytest.mark.parametrize('frame_time, too_slow', [(0.04, True), (0.02, False)])
def test_tells_when_it_is_too_slow(frame_time, too_slow):
    """A slow machine would not be told of, or a fast enough one would."""
    pacing = Pacing(1.0)
    pacing.restart(0.0)
    pacing.delay(frame_time, 0.02)
    assert not pacing.too_slow, 'one frame says nothing yet'
    for frame in range(2, 201):
        pacing.delay(frame_time * frame, 0.02)
    assert pacing.too_slow == too_slow


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
