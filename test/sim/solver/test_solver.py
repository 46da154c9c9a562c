# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Solutions agree with a direct float64 solve, and come out the same twice."""

from itertools import product

from implicit_system import relative_error
import numpy as np
import pytest

FINE = {'tolerance': 1e-6, 'max_iterations': 2000}
# The scrambled cloth of these tests has a condition of some 1e4, which float32 multiplies its
# 6e-8 by; test_draped_cloth.py holds real states to 1e-4.
FLOAT32_ERROR = 1e-3
FLOAT32_RESIDUAL = 5e-6


@pytest.mark.parametrize(('preconditioner', 'shape'), [
    *product(['multigrid'], [(2, 2), (1, 12), (12, 1), (40, 2), (2, 40), (9, 14), (23, 17)]),
    # No levels, so that shapes are all one to it.
    *product(['block_jacobi'], [(1, 12), (9, 14)])])
def test_solution_in_any_shape(make_case, preconditioner, shape, kind, geometric):
    """Cloth of this shape would move as no edges would move it."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'width': 0.6, 'pins': ['0,0']}, kind=kind,
        geometric=geometric, preconditioner=preconditioner, **FINE)
    right = case.solver.right_side()
    solution = case.solve()
    assert relative_error(case.system.times(solution), right) < FLOAT32_RESIDUAL
    assert relative_error(solution, case.system.solve()) < FLOAT32_ERROR


@pytest.mark.parametrize('pins', [['none'], ['top_edge'], ['3,4', '11,2']], ids=lambda p: p[0])
def test_solution_with_any_pins(make_case, preconditioner, pins, kind, geometric):
    """Cloth held like this would move as no edges would move it."""
    case = make_case(
        {'rows': 14, 'cols': 11, 'pins': pins}, kind=kind, geometric=geometric,
        preconditioner=preconditioner, **FINE)
    right = case.solver.right_side()
    solution = case.solve()
    assert relative_error(case.system.times(solution), right) < FLOAT32_RESIDUAL
    assert relative_error(solution, case.system.solve()) < FLOAT32_ERROR
    assert np.all(solution[~case.free[..., 0]] == 0.0)


def test_nothing_moves_when_all_is_pinned(make_case, preconditioner):
    """A cloth without a free node would move, or become NaN."""
    case = make_case({'rows': 9, 'cols': 9, 'pins': ['all']}, preconditioner=preconditioner)
    assert np.all(case.solve() == 0.0)
    report = case.solver.report()
    assert (report.iterations, report.residual, report.reached) == (0, 0.0, True)


@pytest.mark.parametrize('loads', ['texture', 'storage'])
def test_solution_for_a_given_right_side(make_case, preconditioner, loads, geometric):
    """The solver would work for the right side of the step only, or in one layout only."""
    case = make_case(
        {'rows': 12, 'cols': 15, 'loads': loads}, geometric=geometric,
        preconditioner=preconditioner, **FINE)
    right = case.random_vector(3)
    case.solver.set_right_side(right)
    assert relative_error(case.solve(), case.system.solve(right)) < FLOAT32_ERROR


def test_two_solves_are_the_same_to_the_bit(make_case, preconditioner, geometric):
    """Two runs of one scene would part."""
    options = {
        'preconditioner': preconditioner, 'geometric': geometric, 'tolerance': 1e-3,
        'max_iterations': 200}
    first = make_case({'rows': 33, 'cols': 29}, **options)
    solution = first.solve()
    other = first.solve_for(first.random_vector(4))
    second = make_case({'rows': 33, 'cols': 29}, **options)
    assert np.array_equal(second.solve(), solution)
    assert np.array_equal(second.solve_for(first.random_vector(4)), other)


def test_apply_moves_the_cloth(make_case, kind):
    """The solution would not reach the state, or a pinned node would move."""
    case = make_case({'rows': 9, 'cols': 6}, kind=kind, **FINE)
    change = case.solve()
    case.apply()
    positions, velocities = case.read_state()
    assert np.allclose(velocities, case.velocities + change, atol=1e-6)
    assert np.allclose(positions, case.positions + 0.01 * velocities, atol=1e-6)
    assert np.array_equal(positions[~case.free[..., 0]], case.positions[~case.free[..., 0]])


def test_second_apply_adds_only_the_difference(make_case, kind):
    """Nodes would move twice in one step, or their velocities not match."""
    case = make_case({'rows': 9, 'cols': 6}, kind=kind, foresees_turn=True, **FINE)
    case.solve()
    case.apply()
    before = case.read_state()
    case.prepare(is_further=True)
    change = case.solve()
    case.apply(further=True)
    positions, velocities = case.read_state()
    assert np.allclose(velocities, before[1] + change, atol=1e-6)
    assert np.allclose(positions, before[0] + 0.01 * change, atol=1e-6)


def test_a_free_cloth_moves_as_a_whole(make_case):
    """Gravity, which a free cloth gets besides its solution, would be lost."""
    case = make_case({'rows': 9, 'cols': 6, 'pins': ['none']}, **FINE)
    change = case.solve()
    case.solver.apply(case.state, common_change=(0.1, -0.2, 0.5))
    positions, velocities = case.read_state()
    expected = case.velocities + change + np.array((0.1, -0.2, 0.5))
    assert np.allclose(velocities, expected, atol=1e-6)
    assert np.allclose(positions, case.positions + 0.01 * expected, atol=1e-6)
