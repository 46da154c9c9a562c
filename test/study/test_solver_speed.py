# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How fast and how exactly the implicit step is solved, set-up included, on one device."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.edge_law import hard_edges
from cloth_sim_ros.sim.solver.edge_law import spring_law
from cloth_sim_ros.study.solver_speed import compare_solvers
from cloth_sim_ros.study.solver_speed import direct_step
from cloth_sim_ros.study.timed_solvers import BASELINES
from implicit_system import ImplicitSystem
from implicit_system import relative_error
import numpy as np
import pytest
from springs import SPRINGS


def laws(scene: Scene) -> dict[str, EdgeLaw]:
    """Return a law of each kind."""
    return {
        'springs': spring_law(scene, 0.01),
        'hard': hard_edges(scene, 0.01),
        'limited': edge_law(scene, 0.01, limited=('structural', 'shear'), limit=0.05)}


@pytest.mark.parametrize('kind', ['springs', 'hard', 'limited'])
@pytest.mark.parametrize('shape', [(8, 9), (1, 7), (7, 1)])
@pytest.mark.parametrize('is_held', [False, True])
def test_two_ways_to_the_same_step(kind, shape, is_held):
    """A correct result would be reported as an error, or an error pass."""
    rows, cols = shape
    # Two pins with an edge between them, and one apart.
    pins = ['0,0', '0,1' if cols > 1 else '1,0', 'bottom_right'] if is_held else ['none']
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'height': 0.7, 'pins': pins})
    law = laws(scene)[kind]
    random = np.random.default_rng(5)
    free = ~scene.pinned_nodes()[..., None]
    positions = scene.rest_positions() + 0.01 * random.normal(size=(rows, cols, 3))
    velocities = free * random.normal(size=(rows, cols, 3))
    expected = ImplicitSystem(scene, law, positions, velocities, scene['gravity']).solve()
    assert relative_error(
        direct_step(scene, law, positions, velocities), expected) < 1e-9


# The comparison of solvers measures what it says, on every size asked for.


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
