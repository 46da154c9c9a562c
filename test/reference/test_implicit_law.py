# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The law of an edge, and the matrix of a step, each against what it must be by itself."""

from cloth_sim_ros.reference.edge_law import constraint_law
from cloth_sim_ros.reference.edge_law import EdgeLaw
from cloth_sim_ros.reference.edge_law import limited_law
from cloth_sim_ros.reference.edge_law import spring_law
from cloth_sim_ros.reference.implicit_step import EdgeMatrix
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from springs import SPRINGS

LAWS = {'hard': constraint_law, 'limited': limited_law, 'springs': spring_law}


def _two_nodes() -> Scene:
    return Scene({
        **SPRINGS,
        'rows': 1, 'cols': 2, 'width': 1.0, 'node_mass': 0.5, 'stiffness.structural': 40.0,
        'damping.structural': 0.3})


def _tension(law: EdgeLaw, length: float, rate: float = 0.0) -> float:
    return float(law.tension(np.array([length]), np.array([rate]))[0])


# 20 weights of 1 kg stretch 1 m by 1 mm.
# A chain of 1 kg: strain 0.008 for its weight if 0.03 of its one line were 1.
HARDNESS = 9.81 / (0.008 * 0.03)
LIMIT_HARDNESS = 9.81 / (0.002 * 0.03)


@pytest.mark.parametrize(('law', 'length', 'rate', 'tension'), [
    ('springs', 1.3, 2.0, 40.0 * 0.3 + 0.3 * 2.0),
    # As foreseen along a direction that is frozen.
    ('springs', -0.2, 0.0, -40.0 * 1.2),
    ('hard', 1.002, 2.0, HARDNESS * 0.002),
    ('hard', 0.998, 2.0, -HARDNESS * 0.002),
    ('limited', 1.05, 2.0, 40.0 * 0.05 + 0.3 * 2.0),
    # Fully in force from 0.004 beyond the limit on, as if it were at 0.102.
    ('limited', 1.105, 0.0, 40.0 * 0.105 + LIMIT_HARDNESS * 0.003),
    ('limited', 0.895, 0.0, -40.0 * 0.105 - LIMIT_HARDNESS * 0.003),
    # Halfway there it pulls with a quarter of that half width, and at the limit not yet.
    ('limited', 1.102, 0.0, 40.0 * 0.102 + LIMIT_HARDNESS * 0.002 / 4.0),
    ('limited', 1.1, 0.0, 40.0 * 0.1)])
def test_tension(law, length, rate, tension):
    """An edge does not pull with k (l - L0) + k_d dl/dt, and what its limits add."""
    assert _tension(LAWS[law](_two_nodes()), length, rate) == pytest.approx(tension, rel=1e-9)


@pytest.mark.parametrize(('rows', 'cols'), [(1, 9), (9, 1), (4, 30), (33, 80), (34, 34), (60, 50)])
def test_how_hard_an_edge_is(rows, cols):
    """
    One edge that carries a cloth stretches by more than ``constraint.strain``, or another share.

    All lines of a cloth that share the weight stretch by 0.03 of it at most, and few by just that.
    """
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'constraint.strain': 0.02})
    law, lines = constraint_law(scene), min(rows, cols)
    weight = rows * cols * scene.node_mass * 9.81
    alone = law.compliance * weight / law.edges.rest_length
    np.testing.assert_allclose(alone, 0.02 if lines > 33 else 0.02 * 0.03 * lines, rtol=1e-12)
    assert np.all(alone / lines <= 0.02 * 0.03 * (1.0 + 1e-12))


@pytest.mark.parametrize(('hard', 'springs', 'families'), [
    (['structural', 'shear'], [], {'structural', 'shear'}),
    (['shear'], ['bend'], {'shear', 'bend'}),
    (['structural', 'bend'], ['shear'], {'structural', 'bend'}),
    ([], ['structural'], {'structural'}), ([], [], set())])
def test_families_of_mode_constraint(hard, springs, families):
    """Edges that the mode leaves out pull, or those it asks for are not there."""
    # Shear has no springs, but hard shear edges need none.
    law = constraint_law(Scene({
        **SPRINGS, 'rows': 4, 'cols': 5, 'stiffness.shear': 0.0, 'damping.shear': 0.0,
        'constraint.hard': hard, 'constraint.springs': springs}))
    assert set(law.edges.family) == families
    is_hard = law.shortest == law.longest
    np.testing.assert_array_equal(is_hard, law.edges.of(hard))
    assert np.all(law.stiffness[is_hard] == 0.0)
    assert np.all(law.stiffness[~is_hard] > 0.0)
    long = 1.5 * law.edges.rest_length
    assert law.spring_energy(long) == pytest.approx(
        0.5 * np.sum((law.stiffness * (long - law.edges.rest_length)**2)[~is_hard]), abs=1e-15)


@pytest.mark.parametrize('law', LAWS)
def test_tension_is_the_slope_of_the_energy(law):
    """A length does not hold the energy that it takes to reach it."""
    one, step = LAWS[law](_two_nodes()), 1e-6
    for length in np.linspace(0.8, 1.2, 9) + 1e-4:
        slope = (one.energy(np.array([length + step])) - one.energy(np.array([length - step])))
        assert slope / (2.0 * step) == pytest.approx(_tension(one, length), rel=1e-5, abs=1e-5)


def test_a_limit_of_nothing_is_refused():
    """A limit that is a hard edge is taken for a limit, and pulls as both."""
    with pytest.raises(ClothSimError, match='above 0, got 0.0: take constraint_law'):
        limited_law(_two_nodes(), 0.0)


@pytest.mark.parametrize('rows', [3, 7])
def test_the_matrix_is_mass_and_blocks(rows):
    """The dense or the sparse solve solves another system than M + sum of the blocks."""
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': 4})
    edges, free = constraint_law(scene).edges, ~scene.pinned_nodes().ravel()
    random = np.random.default_rng(3)
    half = random.normal(size=(len(edges), 3, 3))
    blocks = half @ half.transpose(0, 2, 1)
    right = random.normal(size=(len(free), 3)) * free[:, None]
    masses = random.uniform(0.5, 2.0, len(free))
    change = EdgeMatrix(edges, free, masses).solve(blocks, right)
    across = np.einsum('eij,ej->ei', blocks, edges.differences(change))
    back = masses[:, None] * change + edges.scatter(across, len(free))
    assert np.all(change[~free] == 0.0)
    np.testing.assert_allclose(back[free], right[free], atol=1e-10)
