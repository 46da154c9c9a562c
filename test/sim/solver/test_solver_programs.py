# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The steps of smoothing suit the weights of the edges."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.sim.solver.solver_programs import smoothing_steps
import numpy as np
import pytest
from springs import SPRINGS


def left_over(steps: tuple[float, float], eigenvalue: np.ndarray) -> np.ndarray:
    """Return what both steps leave of an error with ``eigenvalue``."""
    return (1.0 - steps[0] * eigenvalue) * (1.0 - steps[1] * eigenvalue)


def around_a_node(law: EdgeLaw) -> float:
    """Return what the edges that meet at a node weigh, bend edges those of four nodes."""
    along_row, along_column, diagonal, two_along_row, two_along_column = law.weights
    return (2.0 * (along_row + along_column) + 4.0 * diagonal
            + 8.0 * (two_along_row + two_along_column))


def test_heavy_edges_are_smoothed_from_a_quarter_to_two():
    """An error that no coarser level can correct would stay, or grow."""
    law = hard_edges(Scene({**SPRINGS}), 0.01)
    assert around_a_node(law) > 100.0
    steps = smoothing_steps(law)
    assert np.abs(left_over(steps, np.linspace(0.25, 2.0, 200))).max() < 0.45
    assert np.abs(left_over(steps, np.linspace(0.0, 2.0, 200))).max() <= 1.0


@pytest.mark.parametrize('family', ['structural', 'shear', 'bend'])
@pytest.mark.parametrize('stiffness', [1.0, 10.0, 100.0])
def test_steps_are_those_of_chebyshev(family, stiffness):
    """An error at one end of the eigenvalues would be left as large as at no other."""
    others = {f'stiffness.{each}': 0.0 for each in ('structural', 'shear', 'bend')}
    undamped = {f'damping.{each}': 0.0 for each in ('structural', 'shear', 'bend')}
    # The cloth is not square, so that a weight of the wrong rest length would show.
    scene = Scene({
        **SPRINGS, 'rows': 12, 'cols': 30, 'node_mass': 0.01, **others, **undamped,
        f'stiffness.{family}': stiffness})
    law = spring_law(scene, 0.01)
    around = around_a_node(law)
    count = {'structural': 4.0, 'shear': 4.0, 'bend': 16.0}[family]
    assert around == pytest.approx(count * 1e-4 * stiffness / 0.01)
    least, most = max(0.25, 1.0 / (1.0 + around)), (1.0 + 2.0 * around) / (1.0 + around)
    # The smallest polynomial on the interval that is 1 at 0 has the same value at both ends, and
    # its negative in the middle.
    left = left_over(smoothing_steps(law), np.array([least, 0.5 * (least + most), most]))
    assert left[0] == pytest.approx(left[2], abs=1e-12)
    assert left[1] == pytest.approx(-left[0], abs=1e-12)


def test_bending_is_smoothed_where_edges_do_not_resist():
    """Ripples of a stiff fabric with hard edges would grow in each cycle of the solver."""
    law = hard_edges(Scene({**SPRINGS, 'rows': 64, 'cols': 48, 'bending.rigidity': 1e-3}), 0.01)
    assert around_a_node(law) > 100.0
    # Across the edges: a row or a column of five nodes has 16 c, of which the middle one has 6.
    bending = sum(law.bending_weights)
    largest = (1.0 + 16.0 * bending) / (1.0 + 6.0 * bending)
    assert largest > 2.5
    steps = smoothing_steps(law)
    assert np.abs(left_over(steps, np.linspace(0.25, largest, 200))).max() < 0.6
    assert np.abs(left_over(steps, np.linspace(0.0, largest, 200))).max() <= 1.0


def test_without_edges_a_step_is_exact():
    """Nodes that nothing ties would not fall freely."""
    assert smoothing_steps(hard_edges(Scene({**SPRINGS}), 0.01, families=())) == (1.0, 1.0)


@pytest.mark.parametrize('stiffness', [1e-3, 1.0, 1e2, 1e6])
def test_no_error_grows(stiffness):
    """The preconditioner would not be positive, and the solve would break down."""
    scene = Scene({**SPRINGS, 'stiffness.structural': stiffness, 'damping.structural': 0.0})
    steps = smoothing_steps(spring_law(scene, 0.01))
    # Both, as one after the other comes before and after the coarser levels.
    assert np.abs(left_over(steps, np.linspace(1e-6, 2.0, 500))).max() <= 1.0 + 1e-9
