# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""On a cloth in mid-drape few iterations reach the accuracy the modes ask for."""

from collections.abc import Callable

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from implicit_system import relative_error
import numpy as np
import pytest

MOST_ITERATIONS = {52: 6, 128: 9}
LARGEST_ERROR = {52: 0.10, 128: 0.15}
STEPS = [(False, 0.01), (False, 0.005), (True, 0.01), (True, 0.005)]


@pytest.fixture(scope='module')
def draped(context) -> Callable[[int], tuple[np.ndarray, np.ndarray]]:
    """Return a function from the nodes a side to the unit scene's state after 0.2 s."""
    states = {}

    def state(nodes: int) -> tuple[np.ndarray, np.ndarray]:
        if nodes not in states:
            damping = {f'damping.{name}': 1e-3 for name in ('structural', 'shear', 'bend')}
            simulation = Simulation(Scene({
                'rows': nodes, 'cols': nodes, 'dt': 0.01, 'stiffness.structural': 1000.0,
                'stiffness.shear': 1000.0, 'stiffness.bend': 100.0, **damping}), context=context)
            simulation.advance(0.2)
            snapshot = simulation.snapshot()
            states[nodes] = snapshot.positions, snapshot.velocities
            simulation.close()
        return states[nodes]

    return state


@pytest.mark.parametrize(('hard', 'dt'), STEPS)
@pytest.mark.parametrize('nodes', MOST_ITERATIONS)
def test_iterations_and_error_at_a_hundredth(make_case, draped, nodes, hard, dt):
    """An implicit step would be slow, or so inexact that the cloth moves differently."""
    case = make_case(
        {'rows': nodes, 'cols': nodes}, dt=dt, hard=hard, state=draped(nodes), tolerance=1e-2)
    solution = case.solve()
    report = case.solver.report()
    error = relative_error(solution, case.system.solve())
    print(f'{report.iterations} iterations to {report.residual:.1e}, error {error:.3f}')
    assert report.reached
    assert report.iterations <= MOST_ITERATIONS[nodes]
    assert error <= LARGEST_ERROR[nodes]


@pytest.mark.parametrize(('hard', 'dt'), STEPS)
def test_the_solve_converges_to_the_direct_one(make_case, draped, hard, dt):
    """More iterations would not make the step more accurate."""
    case = make_case(
        {'rows': 52, 'cols': 52}, dt=dt, hard=hard, state=draped(52), tolerance=1e-6,
        max_iterations=60)
    right = case.solver.right_side()
    solution = case.solve()
    residual = relative_error(case.system.times(solution), right)
    error = relative_error(solution, case.system.solve(right))
    print(f'residual {residual:.1e}, error {error:.1e}')
    assert residual <= 5e-5
    assert error <= 1e-4


@pytest.mark.parametrize('hard', [False, True])
def test_multigrid_needs_a_fraction_of_the_iterations(make_case, draped, hard):
    """The coarse levels would not help."""
    counts = {}
    for preconditioner in ('multigrid', 'block_jacobi'):
        case = make_case(
            {'rows': 52, 'cols': 52}, hard=hard, state=draped(52),
            preconditioner=preconditioner, max_iterations=500)
        case.solve()
        counts[preconditioner] = case.solver.report().iterations
    assert 5 * counts['multigrid'] < counts['block_jacobi'] < 500
