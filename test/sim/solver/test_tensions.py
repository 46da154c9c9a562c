# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The tensions that a solve finds are what the law says, and what moves the nodes."""

from cloth_sim_ros.sim.solver.edge_law import BETA
from implicit_system import relative_error
import numpy as np
import pytest

FINE = {'tolerance': 1e-6, 'max_iterations': 2000}
SHAPES = [(1, 9), (9, 1), (2, 2), (7, 10), (13, 16)]
# A tension is a length that float32 rounds to 1e-7, times what an edge weighs. In dv, and so in
# the tensions, the condition of the system multiplies that, as test_solver.py says.
FLOAT32_ERROR = 1e-3


@pytest.mark.parametrize('shape', SHAPES)
def test_tensions_of_a_solve(make_case, shape, kind, geometric):
    """The forces at the pins, and K_geo of the next solve, would be wrong."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'height': 1.3, 'pins': ['0,0']}, kind=kind,
        geometric=geometric, foresees_turn=True, **FINE)
    case.solve()
    tensions = case.solver.tensions()
    assert tensions.shape == (rows, cols, 6)
    assert relative_error(tensions, case.system.tensions(case.system.solve())) < FLOAT32_ERROR


@pytest.mark.parametrize('shape', SHAPES)
def test_tensions_of_a_further_solve(make_case, shape, kind, geometric):
    """A tension would be lost, or counted twice, where a step has two solves."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'height': 1.3, 'pins': ['0,0']}, kind=kind,
        geometric=geometric, foresees_turn=True, **FINE)
    case.solve()
    case.apply()
    case.prepare(is_further=True)
    case.solve()
    expected = case.system.tensions(case.system.solve())
    assert relative_error(case.solver.tensions(), expected) < FLOAT32_ERROR


def test_tensions_and_gravity_move_the_nodes(make_case, kind):
    """Momentum would come from nothing."""
    case = make_case({'rows': 7, 'cols': 10}, kind=kind, **FINE)
    positions, _ = case.read_state()
    change = case.solve()
    impulse = 0.01 * case.scene.node_mass * np.broadcast_to((0.0, 0.0, -9.81), change.shape)
    impulse = impulse.copy()
    tensions = case.solver.tensions().astype(float)
    nodes = list(np.ndindex(7, 10))
    for edge, (down, right) in enumerate([(0, 1), (1, 0), (1, 1), (1, -1), (0, 2), (2, 0)]):
        for row, col in nodes:
            other = row + down, col + right
            if other in nodes:
                away = positions[other] - positions[row, col].astype(float)
                pull = 0.01 * tensions[row, col, edge] * away / np.linalg.norm(away)
                impulse[row, col] += pull
                impulse[other] -= pull
    moved = case.scene.node_mass * change
    # Both ends of an edge get its float32 tension times the step.
    allowed = 1e-6 * 0.01 * np.abs(tensions).max() + FLOAT32_ERROR * np.abs(moved).max()
    assert np.abs((moved - impulse) * case.free).max() < allowed


def test_edges_that_are_not_there_do_not_pull(make_case, kind):
    """A pin would be pulled by another pin, or by what lies beyond the cloth."""
    case = make_case({'rows': 5, 'cols': 6, 'pins': ['top_edge']}, kind=kind, **FINE)
    case.solve()
    tensions = case.solver.tensions()
    assert np.all(tensions[0, :, [0, 4]] == 0.0)
    assert np.all(tensions[:, -1, [0, 2]] == 0.0) and np.all(tensions[:, 0, 3] == 0.0)
    assert np.all(tensions[-1, :, [1, 2, 3]] == 0.0)
    assert np.all(tensions[:, -2:, 4] == 0.0) and np.all(tensions[-2:, :, 5] == 0.0)
    if kind == 'hard':
        assert np.all(tensions[..., 4:] == 0.0)


def test_forgotten_tensions_are_gone(make_case):
    """The first step after a new state would be made with what the old one pulled with."""
    case = make_case({'rows': 7, 'cols': 10}, kind='hard', geometric=BETA, **FINE)
    case.solve()
    assert case.solver.tensions().any()
    case.forget()
    assert not case.solver.tensions().any()
    case.prepare()
    fresh = make_case({'rows': 7, 'cols': 10}, kind='hard', geometric=BETA, is_new=True, **FINE)
    assert np.array_equal(case.solve(), fresh.solve())
