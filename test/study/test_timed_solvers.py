# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The paper's solver, as a baseline, solves the step that it is compared in."""

from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.study.solver_speed import draped_states
from cloth_sim_ros.study.solver_speed import unit_scene
from cloth_sim_ros.study.timed_solvers import PaperSolver
from implicit_system import ImplicitSystem
from implicit_system import relative_error
import numpy as np
import pytest
from springs import SPRINGS


@pytest.fixture(scope='module')
def context() -> Iterator[Context]:
    """Return one context for all."""
    context = Context(single_thread=True)
    yield context
    context.close()


def expected(scene: Scene, state: tuple[np.ndarray, np.ndarray], dt: float) -> np.ndarray:
    """Return dv of a direct float64 solve."""
    law = hard_edges(scene, dt, strain=scene['constraint.strain'])
    return ImplicitSystem(scene, law, *state, scene['gravity']).solve()


@pytest.mark.parametrize('dt', [0.01, 0.005])
@pytest.mark.parametrize(('tolerance', 'error'), [(1e-2, 0.05), (1e-5, 1e-3)])
def test_it_finds_the_step(context, dt, tolerance, error):
    """The baseline would be slow at something else."""
    scene = unit_scene(12)
    state, = draped_states(12, [0.5], context)
    solver = PaperSolver(scene, *state, dt, tolerance=tolerance)
    solver.solve()
    report = solver.report()
    off = relative_error(solver.solution(), expected(scene, state, dt))
    print(f'measured: {report.iterations} iterations, dv error {off:.1e}')
    assert report.reached and report.residual <= tolerance
    assert off <= error
    solver.solve()
    assert solver.report() == report
    solver.delete()


def test_edges_between_pins_and_other_families_are_left_out(context):
    """The matrix would have empty rows, and conjugate gradients would divide by zero."""
    scene = Scene({**SPRINGS, 'rows': 5, 'cols': 7, 'pins': ['top_edge']})
    random = np.random.default_rng(2)
    free = ~scene.pinned_nodes()[..., None]
    state = (scene.rest_positions() + 0.02 * random.normal(size=(5, 7, 3)),
             free * random.normal(size=(5, 7, 3)))
    solver = PaperSolver(scene, *state, 0.01, tolerance=1e-5)
    solver.solve()
    assert len(solver.tensions()) == 24 + 28 + 2 * 24
    assert relative_error(solver.solution(), expected(scene, state, 0.01)) <= 1e-3
    solver.delete()


def test_a_solve_cut_short_says_so(context):
    """The baseline would look faster than it is."""
    state, = draped_states(12, [0.5], context)
    solver = PaperSolver(unit_scene(12), *state, 0.01, max_iterations=5)
    solver.solve()
    report = solver.report()
    assert report.iterations == 5
    assert report.residual > 1e-2 and not report.reached
    solver.delete()
