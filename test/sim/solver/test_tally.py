# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The solves of a step are counted together."""

import numpy as np


def test_a_solve_that_gave_up_is_not_forgotten(make_case):
    """A step would be told reached because its last solve was."""
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
