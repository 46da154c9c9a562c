# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The solves of a step are counted together."""

import math

from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.solver.tally import report_of
import numpy as np
import pytest


@pytest.mark.parametrize(('scale', 'after', 'residual'), [
    (4.0, 1.0, 0.5), (4.0, 0.0, 0.0), (1.0, 4.0, 2.0), (0.0, 0.0, 0.0), (1.0, -1e-4, 1e-2)])
def test_residual_is_the_root_of_the_quotient(scale, after, residual):
    """A NaN would be reported as a residual, or a rounded residual raise an error."""
    report = report_of(scale, after, 3, 0.5)
    assert (report.iterations, report.residual) == (3, pytest.approx(residual))
    assert report.reached == (residual <= 0.5)


@pytest.mark.parametrize(('scale', 'after'), [
    (math.nan, math.nan), (math.inf, math.inf), (1.0, math.nan), (1.0, math.inf),
    (math.inf, math.nan), (-1.0, -1.0), (-1.0, -math.inf)])
def test_what_is_not_finite_was_not_reached(scale, after):
    """A step that is no step would pass as good."""
    assert not report_of(scale, after, 1, 0.5).reached


def test_what_is_left_of_nothing_was_not_reached():
    """A residual that there is no change of velocity to measure by would pass as none."""
    assert not report_of(0.0, 1.0, 1, 0.5).reached


def test_not_converged_after_one_iteration_without_gravity(make_case, preconditioner):
    """A solve would be reported as converged: neither a change nor gravity gives a scale."""
    case = make_case(
        {'rows': 12, 'cols': 9}, preconditioner=preconditioner, tolerance=1e-4, max_iterations=1)
    case.solver.clear_tally()
    case.solver.prepare(case.state, Forcing((0.0, 0.0, 0.0)))
    case.solve()
    assert case.solver.report().iterations == 1
    assert case.solver.tally().unreached == 1
    assert not case.solver.report().reached


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 1e30])
@pytest.mark.parametrize('where', ['right side', 'positions', 'velocities'])
def test_a_solve_from_what_is_not_finite(make_case, preconditioner, where, value):
    """The device would call a NaN a solution."""
    case = make_case({'rows': 12, 'cols': 9}, preconditioner=preconditioner)
    fields = {
        'positions': case.positions, 'velocities': case.velocities,
        'right side': case.solver.right_side()}
    fields[where][5, 4] = value
    case.state.write(fields['positions'], fields['velocities'])
    case.solver.prepare(case.state, case.forcing)
    if where == 'right side':
        case.solver.set_right_side(fields[where])
    solution = case.solve()
    report = case.solver.report()
    print(f'{report}, finite {np.all(np.isfinite(solution))}')
    if not np.all(np.isfinite(solution)) or not math.isfinite(report.residual):
        assert not report.reached
    if not math.isfinite(value):
        assert not report.reached


def test_a_solver_gets_over_what_was_not_finite(make_case, preconditioner):
    """One bad step would leave something behind in the buffers, and spoil those that follow."""
    case = make_case({'rows': 12, 'cols': 9}, preconditioner=preconditioner, max_iterations=300)
    right = case.solver.right_side()
    expected = case.solve()
    case.solve_for(np.full_like(right, math.nan))
    assert not case.solver.report().reached
    case.solver.forget()
    assert np.array_equal(case.solve_for(right), expected)
    assert case.solver.report().reached


def test_a_solve_that_gave_up_is_not_forgotten(make_case):
    """A step would be reported as converged because its last solve was."""
    case = make_case({'rows': 12, 'cols': 9}, tolerance=1e-4, max_iterations=1)
    case.solver.clear_tally()
    case.solve()
    worst = case.solver.report().residual
    case.solve_for(np.zeros((12, 9, 3)))
    assert case.solver.report().reached
    tally = case.solver.tally()
    assert (tally.most_iterations, tally.unreached) == (1, 1)
    assert np.isclose(tally.worst_residual, worst, rtol=1e-5)
    case.solver.clear_tally()
    assert case.solver.tally().unreached == 0


def test_every_solve_counts(make_case):
    """The work of a step would be taken from its longest solve alone."""
    case = make_case({'rows': 12, 'cols': 9}, tolerance=1e-4, max_iterations=30)
    case.solver.clear_tally()
    iterations = []
    for scale in (1.0, 0.0, 1.0):
        case.solve_for(scale * case.free * np.ones((12, 9, 3)))
        iterations.append(case.solver.report().iterations)
    tally = case.solver.tally()
    assert (tally.solves, tally.iterations) == (3, sum(iterations))
    assert tally.most_iterations == max(iterations) < sum(iterations)
    case.solver.clear_tally()
    assert (case.solver.tally().solves, case.solver.tally().iterations) == (0, 0)


def test_what_is_no_number_is_not_reached(make_case):
    """A solve that broke down would look like any other."""
    case = make_case({'rows': 5, 'cols': 5})
    case.solver.clear_tally()
    case.solve_for(np.full((5, 5, 3), np.nan))
    assert case.solver.tally().unreached == 1
