# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Chains, strips and cloths that hang at rest, against the balance of forces at each node."""

from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from scipy.optimize import brentq
from springs import SPRINGS

CHAIN = {'constraint.hard': ['structural'], 'node_mass': 0.01}


def _calm(cloth: ImplicitCloth, steps: int, share: float = 0.9) -> ImplicitCloth:
    """Return the cloth after ``steps`` in air that leaves this share of its speed in each."""
    for _ in range(steps):
        cloth.velocities *= share
        cloth.step()
    return cloth


@pytest.mark.parametrize('dt', [0.02, 0.005])
@pytest.mark.parametrize('solves', [1, 2])
def test_a_chain_stretches_by_the_law(solves, dt):
    """A tension is not the weight below, or an edge at rest not longer by E lambda."""
    chain = _calm(ImplicitCloth(Scene({
        **SPRINGS, **CHAIN, 'rows': 21, 'cols': 1, 'start.pose': 'hanging', 'dt': dt,
        'constraint.newton_iterations': solves})), 400)
    below = np.arange(20, 0, -1) * 0.01 * GRAVITY
    longer = chain.law.edges.lengths(chain.positions.reshape(-1, 3)) - 0.05
    np.testing.assert_allclose(chain.tension, below, rtol=1e-6)
    np.testing.assert_allclose(longer, chain.law.compliance * below, rtol=1e-6)


def _elastic_catenary(
        nodes: int, span: float, rest: float, compliance: float) -> tuple[np.ndarray, np.ndarray]:
    """
    Return where the nodes of 0.01 kg hang, x and z (nodes, 2) [m], and the tensions [N].

    All links have one horizontal pull H, and vertical ones that fall by a weight from link to
    link, 0 in the middle. With its tension T a link is rest + compliance T long.
    """
    carried = ((nodes - 2) / 2.0 - np.arange(nodes - 1)) * 0.01 * GRAVITY

    def links(pull: float) -> tuple[np.ndarray, np.ndarray]:
        tensions = np.hypot(pull, carried)
        each = (rest + compliance * tensions) / tensions
        return np.stack([each * pull, -each * carried], axis=-1), tensions

    pull = brentq(lambda one: links(one)[0][:, 0].sum() - span, 1e-6, 1e4, xtol=1e-13)
    steps, tensions = links(pull)
    return np.concatenate([np.zeros((1, 2)), np.cumsum(steps, axis=0)]), tensions


@pytest.mark.parametrize('solves', [pytest.param(1, marks=pytest.mark.long), 2])
@pytest.mark.parametrize(('span', 'strain', 'steps'), [
    pytest.param(0.8, 1e-5, 800, marks=pytest.mark.long),
    pytest.param(0.8, 0.5, 800, marks=pytest.mark.long),
    (1.0, 0.008, 500)])
def test_catenary(solves, span, strain, steps):
    """A chain, slack or taut, hard or soft, rests elsewhere than forces and lengths allow."""
    chain = ImplicitCloth(Scene({
        **SPRINGS,
        **CHAIN, 'rows': 1, 'cols': 41, 'width': 1.0, 'dt': 0.01, 'constraint.strain': strain,
        # The taut one pulls with 22 N: one solve stands 2 sqrt(0.01 x 0.025 / (4 x 22)) = 3.4 ms.
        'auto_substeps': False, 'substeps': 4, 'constraint.newton_iterations': solves}))
    exact, tensions = _elastic_catenary(41, span, 0.025, chain.law.compliance[0])
    chain.positions[0] = 0.0
    chain.positions[0, :, [0, 2]] = (exact * [1.0, 0.97]).T
    _calm(chain, steps, 0.97)
    off = np.max(np.abs(chain.positions[0][:, [0, 2]] - exact))
    print(f'measured: {solves} solves, span {span} m, strain {strain}, off by {off:.1e} m, '
          f'tensions {np.max(np.abs(chain.tension / tensions - 1.0)):.1e}')
    assert off < 1e-5
    np.testing.assert_allclose(chain.tension, tensions, rtol=1e-4)


def test_tensions_of_a_strip_are_the_weight_below():
    """The vertical pull of the edges between two rows is not the weight below them at rest."""
    strip = _calm(ImplicitCloth(Scene({
        **SPRINGS,
        'rows': 15, 'cols': 4, 'width': 0.3, 'start.pose': 'hanging', 'pins': ['top_edge'],
        'dt': 0.01})), 400)
    edges = strip.law.edges
    pull = strip.tension * edges.directions(strip.positions.reshape(-1, 3))[:, 2]
    for row in range(14):
        crossing = (edges.first // 4 <= row) & (edges.second // 4 > row)
        below = 4 * (14 - row) * strip.scene.node_mass * GRAVITY
        assert pull[crossing].sum() == pytest.approx(below, rel=1e-4)


@pytest.mark.parametrize('pins', [['top_edge'], ['top_left', 'top_right'], ['top_left']])
def test_pin_reactions_are_the_weight(pins):
    """The pins do not hold the cloth's weight, their own nodes' with it."""
    cloth = _calm(ImplicitCloth(Scene({
        **SPRINGS,
        'rows': 6, 'cols': 6, 'pins': pins, 'start.pose': 'hanging', 'dt': 0.01})), 400, 0.95)
    weight = 36 * cloth.scene.node_mass * GRAVITY
    total = cloth.reactions.sum(axis=(0, 1))
    print(f'measured: {pins} off by {np.max(np.abs(total / weight - [0.0, 0.0, 1.0])):.1e}')
    np.testing.assert_allclose(total, [0.0, 0.0, weight], atol=1e-3 * weight)
    assert np.all(cloth.reactions[cloth.free] == 0.0)


@pytest.mark.parametrize('pins', ['all', 'none'])
@pytest.mark.parametrize('hard', [['structural', 'shear'], []])
def test_all_and_no_nodes_pinned(pins, hard):
    """A cloth that can't move, is held nowhere, or has no edges, has no solvable system."""
    cloth = ImplicitCloth(Scene({
        **SPRINGS, 'rows': 5, 'cols': 6, 'dt': 0.01, 'pins': [pins], 'constraint.hard': hard}))
    start = cloth.positions.copy()
    cloth.step(10)
    fall = 0.0 if pins == 'all' else GRAVITY * 0.1 * 0.11 / 2.0
    np.testing.assert_allclose(cloth.positions, start - [0.0, 0.0, fall], atol=1e-12)


def test_moving_pins_carry_the_cloth():
    """A cloth that moves with its pins feels them."""
    cloth = ImplicitCloth(Scene({
        **SPRINGS, 'rows': 5, 'cols': 5, 'gravity': [0.0, 0.0, 0.0], 'dt': 0.01}))
    start, velocity = cloth.positions.copy(), np.array([0.3, 0.1, -0.2])
    cloth.velocities[...] = velocity
    for row, col in np.argwhere(~cloth.free).tolist():
        cloth.move_pin(row, col, velocity)
    cloth.step(20)
    np.testing.assert_allclose(cloth.positions, start + 0.2 * velocity, atol=1e-12)
    # Rounding of lengths, over E.
    assert np.abs(cloth.tension).max() < 1e-14 / cloth.law.compliance.min()


def test_a_pulled_pin_pulls_the_chain():
    """A chain dragged by its pin does not follow at the pin's speed."""
    chain = ImplicitCloth(Scene({
        **SPRINGS,
        **CHAIN, 'rows': 1, 'cols': 6, 'gravity': [0.0, 0.0, 0.0], 'pins': ['top_right'],
        'dt': 0.01}))
    chain.move_pin(0, 5, np.array([0.5, 0.0, 0.0]))
    chain.step(10)
    np.testing.assert_allclose(chain.velocities[0, :, 0], 0.5, rtol=1e-2)
    assert chain.excess() < 1e-4
