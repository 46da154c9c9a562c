# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The comparison of solvers measures what it says, on every size asked for."""

from cloth_sim_ros.study.solver_speed import compare_solvers
from cloth_sim_ros.study.timed_solver import BASELINES
import pytest


def test_each_step_is_measured_at_each_time():
    """A figure would stand for another step, or for a solve that did not get there."""
    comparison, = compare_solvers([9], rounds=2, round_seconds=0.001, times=(0.1, 0.3))
    assert (comparison.rows, comparison.cols) == (9, 9)
    assert comparison.device
    assert comparison.ratios == ()
    assert len({(speed.step, speed.drape_time) for speed in comparison.speeds}) == 8
    for speed in comparison.speeds:
        assert speed.solver == 'multigrid'
        assert len(speed.rounds) == 2
        assert speed.iterations > 0
        assert speed.reached and speed.residual <= 1e-2
        assert 0.0 < speed.velocity_error < 0.1
        assert speed.median > 0.0
    assert comparison.as_dict()['speeds'][0]['step'] == 'springs, dt 0.01 s'


@pytest.mark.parametrize(('name', 'steps'), [('paper', 2), ('block_jacobi', 4)])
def test_a_baseline_has_its_turn_in_the_same_steps(name, steps):
    """The ratio would be one of two different steps."""
    comparison, = compare_solvers(
        [9], rounds=3, round_seconds=0.001, times=(0.2,), baseline=BASELINES[name])
    own, other = comparison.speeds[::2], comparison.speeds[1::2]
    assert [speed.solver for speed in (own[0], other[0])] == ['multigrid', name]
    assert [speed.step for speed in own] == [speed.step for speed in other]
    assert len(own) == steps
    assert all(speed.reached and speed.velocity_error < 0.1 for speed in comparison.speeds)
    assert comparison.ratios == pytest.approx([
        a / b for first, second in zip(own, other)
        for a, b in zip(first.rounds, second.rounds)])
