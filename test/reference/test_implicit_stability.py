# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long a step tight edges stand: one node between two pins, and a hanging chain."""

from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.implicit_step import Passes
from cloth_sim_ros.reference.rigid_links import GRAVITY
from cloth_sim_ros.reference.rigid_links import longest_explicit_pull
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


@pytest.mark.parametrize('beta', [0.0, 0.1, 0.25, 0.5, 1.0])
@pytest.mark.parametrize('turn', [0.3, 1.9, 4.0, 12.0])
def test_a_wave_across_tight_edges(beta, turn):
    """The node is not moved by x+ - 2 x + x- = -(w h)^2 x / (1 + beta (w h)^2), undamped."""
    mass, strain = 0.1, 1e-3
    scene = {'rows': 1, 'cols': 3, 'width': 2.0, 'node_mass': mass, 'gravity': [0.0, 0.0, 0.0],
             'constraint.hard': ['structural']}
    compliance = ImplicitCloth(Scene(scene)).law.compliance[0]
    pull, length = strain / compliance, 1.0 + strain
    # Each of the two edges pulls the node back with (pull / length) x.
    frequency = np.sqrt(2.0 * pull / (length * mass))
    string = ImplicitCloth(
        Scene({**scene, 'dt': turn / frequency, 'auto_substeps': False}), passes=Passes(beta=beta))
    string.positions[0, :, 0] *= length
    start = string.positions[0, 1, 2]
    # So small that the edges do not get longer by it, to 1e-10 of their stretch.
    string.positions[0, 1, 2] += 1e-7 * np.sqrt(strain)
    before = now = string.positions[0, 1, 2] - start
    for _ in range(6):
        string.step()
        before, now = now, 2.0 * now - before - turn**2 / (1.0 + beta * turn**2) * now
        if abs(now) > 1e-5:
            break
        assert string.positions[0, 1, 2] - start == pytest.approx(now, rel=1e-5, abs=1e-12)


def _strays(links, dt, passes, times=1e4):
    """
    Return the most that a chain at rest, disturbed across, is off it within 1500 steps.

    It is the norm over all nodes, over that of the disturbance; beyond ``times`` it is not
    followed.
    """
    chain = ImplicitCloth(Scene({
        'rows': links + 1, 'cols': 1, 'height': 1.0, 'node_mass': 1.0, 'dt': dt,
        'pins': ['top_left'], 'start.pose': 'hanging', 'constraint.hard': ['structural'],
        'auto_substeps': False}), passes=passes)
    below = GRAVITY * np.arange(links, 0.0, -1.0)
    lengths = chain.law.edges.rest_length + chain.law.compliance * below
    chain.positions[1:, 0, 2] = chain.positions[0, 0, 2] - np.cumsum(lengths)
    across = chain.positions[1:, 0, :2].copy()
    chain.positions[1:, 0, :2] += 1e-7 * np.random.default_rng(0).normal(size=(links, 2))
    start = np.linalg.norm(chain.positions[1:, 0, :2] - across)
    far = 1.0
    for _ in range(1500):
        chain.step()
        far = max(far, np.linalg.norm(chain.positions[1:, 0, :2] - across) / start)
        if not far < times:
            break
    return far


@pytest.mark.parametrize('beta', [0.0, 0.1])
@pytest.mark.parametrize('links', [10, pytest.param(20, marks=pytest.mark.long)])
def test_blow_up_of_a_hanging_chain(links, beta):
    """
    One linear solve is stable up to another step than 2 / w / sqrt(1 - 4 beta).

    There h w' = 2 with w'^2 = w^2 / (1 + beta h^2 w^2). A wave turns by the angle a a step,
    sin(a / 2) = h w' / 2, and from rest it swings to 1 / cos(a / 2) of its start: to 3.2 times
    that at 0.95 of the limit without the mass term, to 4 times with beta = 0.1.
    """
    limit = longest_explicit_pull(links) / np.sqrt(1.0 - 4.0 * beta)
    passes = Passes(end=0, foresees_turn=False, beta=beta)
    below, above = (_strays(links, share * limit, passes) for share in (0.95, 1.05))
    print(f'measured: {links} links, beta {beta}, limit {limit:.5f} s, off {below:.1e} and '
          f'{above:.1e} times the start')
    turn = 2.0 * 0.95 / np.sqrt(1.0 - 4.0 * beta * (1.0 - 0.95**2))
    assert below < 1.001 / np.sqrt(1.0 - turn**2 / 4.0)
    assert above >= 1e4


@pytest.mark.parametrize('times', [1.05, pytest.param(3.0, marks=pytest.mark.long), 10.0])
@pytest.mark.parametrize('links', [10, pytest.param(20, marks=pytest.mark.long)])
def test_a_hanging_chain_stands_steps_of_any_length(links, times):
    """
    With the mass term of mode constraint, waves of a chain in long steps grow all the same.

    A wave turns by the angle a a step, sin(a / 2) = h w' / 2, and from rest it swings to
    1 / cos(a / 2) of its start: at most to sqrt(2), as h w' < sqrt(2) with beta = 1/2.
    """
    far = _strays(links, times * longest_explicit_pull(links), Passes())
    print(f'measured: {links} links, at {times} of the limit off {far:.4f} times the start')
    assert far < 1.001 * np.sqrt(2.0)
