# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The exact solution for edges at their strain limit, against what it must fulfil by itself."""

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.limited_cloth import CLOSING
from cloth_sim_ros.reference.limited_cloth import LimitedSpringsReference
from cloth_sim_ros.reference.limited_cloth import LimitProjection
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from measured import within
import numpy as np
import pytest
from springs import SPRINGS

LIMIT, STEP = 0.02, 0.002
FREE = {'pins': ['none'], 'gravity': [0.0, 0.0, 0.0]}
SCENE = {
    **SPRINGS, 'rows': 6, 'cols': 5, 'adaptive.threshold': LIMIT, 'stiffness.structural': 2.0,
    'stiffness.shear': 2.0, 'stiffness.bend': 0.0, 'damping.bend': 0.0, 'auto_substeps': False,
    'dt': STEP}


def thrown(scene, strain, speed=0.3, seed=2):
    """
    Return limited edges, positions and random velocities of a cloth that is stretched.

    :param strain: of all edges, over the limit
    """
    random = np.random.default_rng(seed)
    positions = (1.0 + strain * LIMIT) * scene.start_positions().reshape(-1, 3)
    velocities = speed * random.standard_normal(positions.shape)
    velocities[scene.pinned_nodes().ravel()] = 0.0
    return edges_of(scene).only(('structural', 'shear')), positions, velocities


@pytest.mark.parametrize('strain', [0.98, -0.98, 1.5, -1.5])
@pytest.mark.parametrize('pins', ['none', 'top_left', 'top_edge'])
def test_limits_are_kept_and_nothing_else_is_done(strain, pins):
    """
    What decides on the projection: limits, complementary impulses, and directions.

    Those are the conditions of Karush, Kuhn and Tucker: what fulfils them is the only minimum.
    """
    scene = Scene({**SCENE, 'pins': [pins]})
    edges, positions, velocities = thrown(scene, strain)
    free = ~scene.pinned_nodes().ravel()
    mass = scene.node_mass
    found = LimitProjection(edges, free / mass, LIMIT)(positions, velocities, STEP)
    d = edges.differences(positions)
    lengths = np.linalg.norm(d, axis=1)
    along = d / lengths[:, None]
    q = d + STEP * edges.differences(found.velocities)
    after, part = np.linalg.norm(q, axis=1), np.sum(q * along, axis=1)
    longest = np.maximum(
        edges.rest_length * (1.0 + LIMIT),
        lengths - CLOSING * (lengths - edges.rest_length * (1.0 + LIMIT)))
    shortest = np.minimum(
        edges.rest_length * (1.0 - LIMIT),
        lengths - CLOSING * (lengths - edges.rest_length * (1.0 - LIMIT)))
    # Nothing moves an edge between two pins.
    moves = free[edges.first] | free[edges.second]
    past = np.maximum(after - longest, shortest - part)
    within('length past a limit [m]', np.max(past[moves]), 1e-11)
    pulled = np.linalg.norm(found.impulses, axis=1)
    scale = pulled.max()
    assert scale > 0.0
    side = np.sum(found.impulses * along, axis=1)
    slack = np.where(side > 0.0, longest - after, part - shortest)
    within('impulse of an edge that is not at its limit, over the largest',
           np.max(pulled[slack > 1e-9], initial=0.0) / scale, 1e-9)
    toward = np.where(side[:, None] > 0.0, q / after[:, None], -along)
    within('impulse across its edge, or away from its limit, over the largest',
           np.abs(found.impulses - pulled[:, None] * toward).max() / scale, 1e-9)
    given = -edges.scatter(found.impulses, len(free))
    within('velocities, off those by the impulses [m/s]', np.abs(
        found.velocities - velocities - free[:, None] * given / mass).max(), 1e-12)


def test_no_other_velocities_are_nearer():
    """It would be some feasible point, or that of another metric."""
    scene = Scene({**SCENE, 'pins': ['top_left']})
    edges, positions, velocities = thrown(scene, 0.98)
    free = ~scene.pinned_nodes().ravel()
    project = LimitProjection(edges, free / scene.node_mass, LIMIT)
    found = project(positions, velocities, STEP).velocities
    random = np.random.default_rng(5)
    for _ in range(20):
        other = found + free[:, None] * random.normal(0.0, 0.05, found.shape)
        other = project(positions, other, STEP).velocities
        # In a convex set, the way on from the nearest point leads away from the given one.
        within('cosine of a way to another feasible point',
               np.sum((velocities - found) * (other - found))
               / (np.linalg.norm(velocities - found) * np.linalg.norm(other - found)), 1e-8)


@pytest.mark.parametrize('strain', [0.98, -0.98])
def test_it_gives_no_momentum_and_no_energy(strain):
    """Impulses act on one end more than on the other, or throw the cloth."""
    scene = Scene({**SCENE, **FREE})
    edges, positions, velocities = thrown(scene, strain)
    found = LimitProjection(edges, np.full(30, 1.0 / scene.node_mass), LIMIT)(
        positions, velocities, STEP)
    change = found.velocities - velocities
    assert np.any(change)
    within('momentum over that of all nodes',
           np.abs(change.sum(axis=0)).max() / np.abs(velocities).sum(), 1e-13)
    within('energy after over that before',
           np.sum(found.velocities**2) / np.sum(velocities**2), 1.0)


def test_a_ball_keeps_angular_momentum_at_the_end():
    """Impulses of upper limits act along edges as they are after the substep."""
    scene = Scene({**SCENE, **FREE})
    edges, positions, velocities = thrown(scene, 0.98)
    found = LimitProjection(edges, np.full(30, 1.0 / scene.node_mass), LIMIT)(
        positions, velocities, STEP)
    long = np.sum(found.impulses * edges.differences(positions), axis=1) > 0.0
    assert np.count_nonzero(long) > 20
    given = edges.scatter(np.where(long[:, None], found.impulses, 0.0), 30)
    after = positions + STEP * found.velocities
    within('angular momentum over its parts', np.abs(np.cross(after, given).sum(axis=0)).max()
           / np.abs(np.cross(after, given)).sum(), 1e-9)


def test_an_edge_beyond_its_limit_comes_back_by_a_tenth():
    """It would leap back, or stay."""
    scene = Scene({**SCENE, **FREE, 'rows': 1, 'cols': 2, 'width': 1.0})
    edges = edges_of(scene)
    positions = np.array([[0.0, 0.0, 0.0], [1.05, 0.0, 0.0]])
    found = LimitProjection(edges, np.full(2, 1.0 / scene.node_mass), LIMIT)(
        positions, np.zeros((2, 3)), STEP)
    length = 1.05 + STEP * np.ptp(found.velocities[:, 0]) * np.sign(
        found.velocities[1, 0] - found.velocities[0, 0])
    assert length == pytest.approx(1.02 + 0.9 * 0.03, abs=1e-12)


def test_two_pins_that_tear_are_refused():
    """Rounds would never end, or their result would exceed the limit."""
    scene = Scene({**SCENE, 'rows': 1, 'cols': 3, 'pins': ['top_left', 'top_right']})
    positions = scene.rest_positions().reshape(-1, 3)
    positions *= 1.5
    velocities = np.zeros((3, 3))
    velocities[2, 0] = 100.0
    project = LimitProjection(edges_of(scene).only(('structural',)), np.array(
        [0.0, 1.0, 0.0]) / scene.node_mass, LIMIT)
    with pytest.raises(ClothSimError, match='move pins more slowly or raise the limit'):
        project(positions, velocities, STEP)


def test_a_cloth_within_its_limit_is_mass_spring():
    """Limits pull at edges that are not at them."""
    scene = Scene({**SCENE, 'adaptive.threshold': 0.5, 'pins': ['top_edge']})
    limited, springs = LimitedSpringsReference(scene), MassSpringReference(scene)
    limited.step(20)
    springs.step(20)
    assert np.array_equal(limited.positions, springs.positions)
    assert not limited.impulses.any()


def test_a_hanging_cloth_pulls_at_its_pins_with_its_weight():
    """The pull of the limits is missing in the force of pins, or counted twice."""
    scene = Scene({
        **SCENE, 'start.pose': 'hanging', 'pins': ['top_edge'], 'damping.structural': 0.5,
        'damping.shear': 0.5})
    cloth = LimitedSpringsReference(scene)
    cloth.advance(1.5)
    assert np.linalg.norm(cloth.impulses, axis=1).max() > 0.0
    weight = scene.mass * 9.81
    within('sum of the reactions, off the weight, over it',
           np.abs(cloth.reactions.sum(axis=(0, 1)) - [0.0, 0.0, weight]).max() / weight, 1e-3)
    within('kinetic energy that limits have given in a substep [J]', cloth.largest_rise, 1e-15)
    # An edge that carries the whole cloth is a tenth of the limit beyond it.
    within('strain over the limit', cloth.strains_over_limit().max(), 1.1)


@pytest.mark.parametrize('dt', [0.0005, 0.002])
def test_a_limit_gives_way_by_force_alone(dt):
    """A limit would be softer in longer substeps."""
    scene = Scene({
        **SCENE, 'rows': 2, 'cols': 1, 'pins': ['top_left'], 'start.pose': 'hanging', 'dt': dt,
        'damping.structural': 1.0})
    cloth = LimitedSpringsReference(scene)
    cloth.advance(1.0)
    stretch = float(cloth.limited.lengths(cloth.positions.reshape(-1, 3))[0]) - 1.0
    # E of one line that carries two nodes: a tenth of the limit of strain, times 0.03.
    force = scene.node_mass * 9.81 - 2.0 * stretch
    compliance = 0.1 * LIMIT * 0.03 / (2.0 * scene.node_mass * 9.81)
    assert stretch == pytest.approx(LIMIT + compliance * force, abs=1e-9)
