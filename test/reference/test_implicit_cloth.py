# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth stepped by ``ImplicitStep``: its substeps, its pins, and what could not be met."""

import math

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.implicit_cloth import turn_substep
from cloth_sim_ros.reference.implicit_step import Passes
from cloth_sim_ros.reference.rigid_links import catenary
from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS


def test_turn_of_a_rod():
    """The turning rate is not the speed across the edge over its length."""
    edges = edges_of(Scene({'rows': 2, 'cols': 1, 'height': 0.5}))
    positions = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.5]])
    velocities = np.array([[0.3, 0.0, 7.0], [0.0, -0.4, 3.0]])
    h = turn_substep(edges, positions, velocities)
    assert (0.5 / 0.5 * h)**2 / 2.0 == pytest.approx(0.002)
    assert turn_substep(edges, positions, np.zeros((2, 3))) == math.inf


@pytest.mark.parametrize(('rate', 'is_largest'), [(1.2, False), (4.0, True), (60.0, False)])
def test_few_fast_edges_do_not_set_the_substep_of_all(rate, is_largest):
    """A fine cloth would be stepped for a few of its edges, or those few would get too long."""
    edges = edges_of(Scene({**SPRINGS, 'rows': 2001, 'cols': 1, 'height': 1.0}))
    edges = edges.only(['structural'])
    positions = np.zeros((2001, 3))
    positions[:, 2] = -np.arange(2001) / 2000.0
    rates = np.ones(2000)
    rates[17] = rate
    velocities = np.zeros((2001, 3))
    velocities[1:, 0] = np.cumsum(rates / 2000.0)
    turns = 0.5 * (rates * turn_substep(edges, positions, velocities))**2
    mean = (rates**4 * turns).sum() / (rates**4).sum()
    if is_largest:
        assert mean < 0.002 and turns.max() == pytest.approx(0.0075)
    else:
        assert mean == pytest.approx(0.002) and turns.max() < 0.0075


# The implicit cloth in free motion, in long steps, and at what it cannot meet.

FREE = {'pins': ['none'], 'gravity': [0.0, 0.0, 0.0]}
NO_BEND = {'stiffness.bend': 0.0, 'damping.bend': 0.0}


def test_a_chain_keeps_the_energy_it_starts_with():
    """A jittered chain of hard edges, in steps of 0.02 ms, makes energy from nothing."""
    chain = ImplicitCloth(Scene({
        **SPRINGS,
        'rows': 1, 'cols': 12, 'node_mass': 0.003, 'start.jitter': 0.1, 'dt': 2e-5, **FREE}))
    start, most, kinetic = chain.energies().total, 0.0, 0.0
    for _ in range(1000):
        chain.step()
        now = chain.energies()
        most, kinetic = max(most, now.total), max(kinetic, now.kinetic)
    print(f'measured: start {start:.4g} J, most {most / start:.4f} of it, kinetic {kinetic:.3g} J')
    assert most <= 1.01 * start


@pytest.mark.parametrize('pose', ['horizontal', 'jittered'])
def test_a_long_step_keeps_lengths(pose):
    """Edges of a cloth that falls in steps of 0.066 s, and is caught, are off by 5 % or more."""
    cloth = ImplicitCloth(Scene({
        **SPRINGS,
        'rows': 7, 'cols': 9, 'dt': 0.066, 'start.jitter': 0.0 if pose == 'horizontal' else 0.1}))
    worst, most = 0.0, 0
    for _ in range(30):
        cloth.step()
        worst, most = max(worst, cloth.excess()), max(most, cloth.report.substeps)
    print(f'measured: {pose} lengths off by {worst:.2e}, at most {most} substeps')
    assert worst <= 0.05


def test_substeps_are_those_that_the_scene_asks_for():
    """Substeps are not the least that keep to the turn, times refine, up to their most."""
    def substeps(**values) -> int:
        cloth = ImplicitCloth(Scene({
            **SPRINGS,
            'rows': 2, 'cols': 1, 'pins': ['top_left'], 'gravity': [0.0, 0.0, 0.0], 'dt': 0.05,
            **values}))
        # (omega h)^2 / 2 is 0.002 at a third of dt, and a little less.
        cloth.velocities[1, 0] = [1.0001 * 3.0 * np.sqrt(0.004) / 0.05, 0.0, 0.0]
        cloth.step()
        return cloth.report.substeps

    assert substeps() == 4
    assert substeps(dt=0.0499) == 3
    assert substeps(refine=3) == 12
    assert substeps(refine=3, **{'constraint.max_substeps': 5}) == 5
    assert substeps(auto_substeps=False, substeps=7) == 7


@pytest.mark.parametrize(('beta', 'end', 'most'), [
    (0.0, 0, 1e-12), (0.0, 1, 1e-3), (0.5, 1, 5e-3)])
def test_momentum_of_a_tumbling_cloth(beta, end, most):
    """A tension does not pull both ends alike, or along its edge; K_geo turns a cloth more."""
    cloth = ImplicitCloth(
        Scene({**SPRINGS, 'rows': 7, 'cols': 6, 'dt': 0.005, **FREE}),
        passes=Passes(beta=beta, end=end))
    cloth.velocities += np.random.default_rng(4).normal(0.0, 0.3, cloth.positions.shape)
    cloth.velocities[..., 2] += 2.0 * cloth.positions[..., 0]

    def momenta() -> tuple[np.ndarray, np.ndarray]:
        return (cloth.velocities.sum(axis=(0, 1)),
                np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1)))

    before, scale = momenta(), np.abs(cloth.velocities).sum()
    cloth.step(100)
    after = momenta()
    turned = np.abs(after[1] - before[1]).max() / np.linalg.norm(before[1])
    lost = np.abs(after[0] - before[0]).max() / scale
    print(f'measured: beta {beta} end {end} momentum {lost:.1e}, angular momentum {turned:.1e}')
    assert lost < 1e-12
    assert turned < most


def test_reactions_balance_the_momentum():
    """
    With moving pins, pushes and substeps: what the pins give is not what the cloth gets.

    Velocities belong to the middle of a substep. Gravity has acted on them for half the first
    substep more, as they begin with it, and half the last less.
    """
    scene = Scene({
        **SPRINGS, 'rows': 6, 'cols': 7, 'dt': 0.02, 'pins': ['top_left', 'top_right', '3,2'],
        'pushes.start': [0.05], 'pushes.duration': [0.07], 'pushes.force': [0.3, 0.2, 5.0],
        'pushes.center': [0.0, 0.0, 1.0], 'pushes.radius': [0.4]})
    cloth = ImplicitCloth(scene)
    given, taken = np.zeros(3), []
    for step in range(18):
        for pin in ((0, 0), (0, 6)):
            cloth.move_pin(*pin, np.array([0.2 * np.sin(step), 0.0, 0.4 * np.cos(3 * step)]))
        cloth.step()
        taken.append(cloth.report.substeps)
        given += cloth.dt * (
            cloth.reactions.sum(axis=(0, 1)) - [0.0, 0.0, 42 * scene.node_mass * GRAVITY])
    pushed = 0.07 * np.array([0.3, 0.2, 5.0])
    momentum = scene.node_mass * cloth.velocities.sum(axis=(0, 1))
    given[2] -= 39 * scene.node_mass * GRAVITY * 0.5 * (0.02 / taken[0] - 0.02 / taken[-1])
    np.testing.assert_allclose(momentum, given + pushed, atol=1e-10)
    assert taken[0] != taken[-1]


@pytest.mark.parametrize('max_force', [20.0, np.inf])
def test_pins_that_pull_too_much_stand_still(max_force):
    """Two pins that part farther than the cloth is long tear at it without bound or report."""
    chain = ImplicitCloth(Scene({
        **SPRINGS,
        'rows': 1, 'cols': 9, 'node_mass': 0.02, 'dt': 0.02, **NO_BEND}), max_force=max_force)
    chain.positions[0] = 0.0
    chain.positions[0, :, [0, 2]] = catenary(9, 1.0, 0.8).T
    chain.move_pin(0, 0, np.array([-0.2, 0.0, 0.0]))
    chain.move_pin(0, 8, np.array([0.2, 0.0, 0.0]))
    stopped, most = 0, 0.0
    for _ in range(50):
        chain.step()
        stopped += bool(chain.report.stopped.any())
        most = max(most, np.linalg.norm(chain.reactions, axis=-1).max())
    apart = np.linalg.norm(chain.positions[0, 8] - chain.positions[0, 0])
    print(f'measured: bound {max_force} N: {most:.4g} N at most, stopped in {stopped} of 50 '
          f'steps, {apart:.4f} m apart, {chain.energies().kinetic:.1e} J')
    if max_force < np.inf:
        assert 10 < stopped < 50
        # What moves it is bounded; a chain that still swings is caught by pins that stand.
        assert most <= 4.0 * max_force
        assert apart < 1.002
    else:
        assert not stopped
        assert most > 1e3


def test_a_force_of_nothing_is_refused():
    """Pins that may not pull are taken, and never move."""
    with pytest.raises(ClothSimError, match='above 0 N, got 0.0: leave it out'):
        ImplicitCloth(Scene(), max_force=0.0)


def test_passes_that_make_no_step_are_refused():
    """A step without a pass is taken, and fails in the middle of a run."""
    with pytest.raises(ClothSimError, match='start of the passes must be 1 or more, got 0'):
        Passes(start=0)
