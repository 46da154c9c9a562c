# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The constraint mode on chains: where they hang, how tight, how long a step they stand."""

from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.reference.rigid_links import longest_explicit_pull
import numpy as np
import pytest
from scipy.optimize import brentq

CHAIN = {'mode': 'constraint', 'auto_substeps': False, 'solver.tolerance': 1e-6}


def test_catenary(simulate, within):
    """A hanging chain does not come to rest where tan of the angles grows link by link."""
    nodes, span = 41, 0.8
    strain = 1e-3
    # A hard edge carries its tension by a strain: that of a chain is 0.03 of constraint.strain
    # under the weight of all its nodes.
    falling = (nodes - 2) / 2.0 - np.arange(nodes - 1)

    def angles(pull):
        return np.arctan2(falling, pull)

    def links(pull):
        return (1.0 + 0.03 * strain * np.hypot(falling, pull) / nodes) / (nodes - 1)

    pull = brentq(lambda h: (links(h) * np.cos(angles(h))).sum() - span, 1e-3, 1e4)
    exact = np.zeros((1, nodes, 3))
    exact[0, 1:, 0] = np.cumsum(links(pull) * np.cos(angles(pull)))
    exact[0, 1:, 2] = -np.cumsum(links(pull) * np.sin(angles(pull)))
    simulation = simulate({
        **CHAIN, 'rows': 1, 'cols': nodes, 'width': 1.0, 'node_mass': 0.01, 'dt': 1e-3,
        'start.z': 0.0, 'constraint.strain': strain})
    simulation.set_state(exact * [1.0, 1.0, 0.999], np.zeros_like(exact))
    for _ in range(150):
        simulation.step(5)
        snapshot = simulation.snapshot()
        simulation.set_state(snapshot.positions, 0.93 * snapshot.velocities)
    simulation.step()
    snapshot = simulation.snapshot(tension=True)
    within('off the catenary [m]', np.abs(snapshot.positions - exact).max(), 1e-5)
    horizontal = 0.01 * GRAVITY * pull
    tension = snapshot.tension[0, :-1, 0] * np.cos(angles(pull)) / horizontal
    within('tension of a catenary, relative', np.abs(tension - 1.0).max(), 1e-3)


def _strays(simulate, links, dt):
    """Return how far a slightly disturbed chain goes in 1500 steps [m]."""
    simulation = simulate({
        **CHAIN, 'rows': links + 1, 'cols': 1, 'height': 1.0, 'node_mass': 1.0, 'dt': dt,
        'pins': ['top_left'], 'start.pose': 'hanging', 'start.z': 0.0,
        'constraint.newton_iterations': 1})
    rest = simulation.snapshot().positions.copy()
    noise = 1e-5 * np.random.default_rng(0).normal(size=rest.shape)
    noise[0] = 0.0
    simulation.set_state(rest + noise, np.zeros_like(rest))
    far = 0.0
    for _ in range(60):
        simulation.step(25)
        far = max(far, float(np.abs(simulation.snapshot().positions - rest).max()))
        if not far < 0.1:
            break
    return far


@pytest.mark.parametrize('links', [10, pytest.param(20, marks=pytest.mark.long)])
def test_blow_up_of_a_hanging_chain(simulate, within, links):
    """One linear solve is stable up to another step than the geometric limit."""
    limit = longest_explicit_pull(links)
    within('stray 5 % below the limit [m]', _strays(simulate, links, 0.95 * limit), 0.01)
    above = _strays(simulate, links, 1.05 * limit)
    print(f'measured {above:.1e} m: stray 5 % above the limit')
    assert above > 0.1
