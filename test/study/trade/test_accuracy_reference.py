# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The converged reference is the motion of the springs in continuous time."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.make_runs import perform
from cloth_sim_ros.study.trade.accuracy import distances
from cloth_sim_ros.study.trade.accuracy import extrapolated
from cloth_sim_ros.study.trade.accuracy import finest
from cloth_sim_ros.study.trade.accuracy import Path
from cloth_sim_ros.study.trade.grid import Plan
from cloth_sim_ros.study.trade.grid import Variant
from made_study import small_grid
from made_study import SOFT
import numpy as np
import pytest
from scipy.integrate import solve_ivp

TIMES = [0.1, 0.2, 0.3, 0.4, 0.5]


@pytest.fixture(scope='module')
def exact():
    """Return the positions at TIMES by scipy's DOP853."""
    begin = MassSpringReference(Scene(SOFT))
    solved = solve_ivp(
        begin.right_hand_side, (0.0, TIMES[-1]),
        np.concatenate((begin.positions.ravel(), begin.velocities.ravel())),
        method='DOP853', rtol=1e-11, atol=1e-12, t_eval=TIMES)
    half = begin.positions.size
    return solved.y[:half].T.reshape(len(TIMES), *begin.positions.shape)


@pytest.mark.parametrize('work, device', [(1e9, 'float64'), (0.0, 'llvmpipe')])
def test_it_is_that_of_an_independent_solver(exact, work, device):
    """Every error of a study would be measured against another motion."""
    grid = small_grid(times=TIMES, reference={
        'refine': [4, 8, 16], 'converged': 1e-4, 'loosely_converged': 1e-4,
        'float64_node_steps': work})
    plan = Plan(Scene(SOFT), grid)
    runs = plan.references(Variant())
    is_float64 = 'spring_reference' in runs[0].function
    assert is_float64 == (device == 'float64')
    reference = extrapolated(
        [perform(run, False) for run in runs], grid.reference_refine)
    off = distances(reference.path, Path(exact, np.zeros(1), np.zeros((1, 3))))
    print(f'measured {off.max():.1e} of 1e-4 m allowed: reference against DOP853 ({device})')
    assert off.max() < 1e-4
    # Its error estimate is of the order of its error.
    assert reference.changes.max() > 0.3 * off.max()
    assert reference.converged_times(1e-4) == len(TIMES)


def test_times_count_until_the_first_that_has_not_converged():
    """A time after the cloth has become chaotic would count."""
    still = np.zeros((3, 2, 2, 3))
    moved = still.copy()
    moved[1] += 0.1
    made = [
        type('Made', (), {'arrays': {
            'positions': positions, 'strains': np.zeros(3), 'energies': np.zeros((3, 3))},
            'device': 'none', 'key': 'a'})() for positions in (still, moved)]
    reference = finest(made)
    assert reference.converged_times(0.05) == 1
    assert finest(made[:1]).converged_times(0.05) == 0
