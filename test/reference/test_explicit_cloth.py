# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloths stepped by symplectic Euler: mass-spring, and the adaptive scheme of the paper."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.reference.explicit_cloth import PaperAdaptiveReference
from cloth_sim_ros.sim.scene import Scene
from limit_scenes import paper_scene
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from springs import SPRINGS

FREE = {'gravity': [0.0, 0.0, 0.0], 'pins': ['none']}


def test_free_fall_follows_its_recurrence():
    """Velocity and position are not stepped in the order of symplectic Euler."""
    cloth = MassSpringReference(Scene({
        **SPRINGS, 'rows': 3, 'cols': 4, 'pins': ['none'], 'start.z': 0.0, 'dt': 0.01,
        'auto_substeps': False}))
    cloth.advance(1.0)
    np.testing.assert_allclose(cloth.positions[..., 2], -9.81 * 1.01 / 2.0, rtol=1e-12)
    assert cloth.time == pytest.approx(1.0)


def test_oscillator_follows_its_recurrence():
    """One spring does not swing with cos(Omega h) = 1 - (omega h)^2 / 2."""
    scene = Scene({**SPRINGS, **FREE, 'rows': 2, 'cols': 1, 'pins': ['top_left'], 'node_mass': 0.1,
                   'start.z': 0.0, 'damping.structural': 0.0, 'dt': 0.01,
                   'auto_substeps': False})
    cloth = MassSpringReference(scene)
    cloth.positions[1, 0, 1] -= 0.05
    trajectory = []
    for _ in range(200):
        trajectory.append(-0.5 - cloth.positions[1, 0, 1])
        cloth.step()
    phase = np.arccos(1.0 - 100.0 / 0.1 * 0.01**2 / 2.0)
    steps = np.arange(200)
    first = 0.05 * (1.0 - 100.0 / 0.1 * 0.01**2)
    sine = (first - 0.05 * np.cos(phase)) / np.sin(phase)
    np.testing.assert_allclose(
        trajectory, 0.05 * np.cos(steps * phase) + sine * np.sin(steps * phase), atol=1e-12)


def test_pinned_nodes_stay():
    """A pinned node moves, or a free one does not."""
    scene = Scene({**SPRINGS, 'rows': 4, 'cols': 3, 'pins': ['top_edge', '2,1'], 'dt': 0.002})
    cloth = MassSpringReference(scene)
    cloth.advance(0.3)
    pinned = scene.pinned_nodes()
    np.testing.assert_array_equal(cloth.positions[pinned], scene.rest_positions()[pinned])
    assert np.all(cloth.positions[~pinned] != scene.rest_positions()[~pinned])


def test_substeps_are_smaller_steps():
    """Two substeps of 2 ms are not the same as two steps of 2 ms."""
    values = {'rows': 4, 'cols': 4, 'auto_substeps': False,
              'pushes.start': [0.05], 'pushes.duration': [0.1],
              'pushes.force': [0.0, 0.1, 1.0]}
    split = MassSpringReference(Scene({**SPRINGS, **values, 'dt': 0.004, 'substeps': 2}))
    plain = MassSpringReference(Scene({**SPRINGS, **values, 'dt': 0.002}))
    split.advance(0.4)
    plain.advance(0.4)
    np.testing.assert_allclose(split.positions, plain.positions, atol=1e-12)


def test_free_cloth_keeps_its_momentum():
    """Inner forces do not cancel: they are not equal and opposite along the spring."""
    scene = Scene({**SPRINGS, **FREE, 'rows': 5, 'cols': 4, 'dt': 0.001})
    cloth = MassSpringReference(scene)
    random = np.random.default_rng(4)
    cloth.positions += 0.03 * random.standard_normal(cloth.positions.shape)
    cloth.velocities += random.standard_normal(cloth.positions.shape)
    linear = cloth.velocities.sum(axis=(0, 1))
    angular = np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1))
    cloth.advance(1.0)
    np.testing.assert_allclose(cloth.velocities.sum(axis=(0, 1)), linear, atol=1e-12)
    np.testing.assert_allclose(
        np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1)), angular, atol=1e-12)


def test_undamped_energy_error_is_first_order():
    """Energy drifts, or its error is not of first order in dt."""
    ripples = []
    for dt in (2e-3, 1e-3, 5e-4):
        cloth = MassSpringReference(Scene({
            **SPRINGS,
            'rows': 6, 'cols': 6, 'dt': dt, 'auto_substeps': False, 'stiffness.bend': 50.0,
            **{f'damping.{family}': 0.0 for family in ('structural', 'shear', 'bend')}}))
        start = cloth.energies().total
        worst = 0.0
        for _ in range(100):
            cloth.advance(0.01)
            worst = max(worst, abs(cloth.energies().total - start))
        ripples.append(worst / (0.2 * 9.81))
    assert ripples[0] < 0.02
    assert ripples[0] / ripples[1] > 1.5
    assert ripples[1] / ripples[2] > 1.5


def test_first_order_against_dop853():
    """The scheme converges to another motion than that of its forces, or at another rate."""
    values = {'rows': 8, 'cols': 8, 'auto_substeps': False,
              'stiffness.structural': 20.0, 'stiffness.shear': 20.0, 'stiffness.bend': 2.0}
    begin = MassSpringReference(Scene(values))
    exact = solve_ivp(
        begin.right_hand_side, (0.0, 0.25),
        np.concatenate((begin.positions.ravel(), begin.velocities.ravel())),
        method='DOP853', rtol=1e-10, atol=1e-11)
    target = exact.y[:begin.positions.size, -1].reshape(begin.positions.shape)
    errors = []
    for dt in (1e-3, 5e-4, 2.5e-4):
        cloth = MassSpringReference(Scene({**SPRINGS, **values, 'dt': dt}))
        cloth.advance(0.25)
        errors.append(np.sqrt(np.mean(np.sum((cloth.positions - target) ** 2, axis=-1))))
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    print(f'measured {orders.round(3)} of 0.95 to 1.1 allowed: order against DOP853')
    assert np.all((orders > 0.95) & (orders < 1.1))


# The paper's adaptive scheme: springs, momentum, and the failure the paper reports.


def test_stretched_edge_returns_to_rest_length():
    """A stretched edge is not pulled back by |d|^2 = L0^2, linearised, in one step."""
    cloth = PaperAdaptiveReference(Scene({
        **SPRINGS, 'rows': 2, 'cols': 1, 'node_mass': 0.1, 'pins': ['top_left'], 'dt': 0.01,
        'auto_substeps': False, 'gravity': [0.0, 0.0, 0.0]}), delta=1e-12)
    cloth.positions[1, 0] = cloth.positions[0, 0] + [0.0, -1.2, 0.0]
    assert cloth.held().all()
    cloth.step()
    length = np.linalg.norm(cloth.positions[1, 0] - cloth.positions[0, 0])
    assert length == pytest.approx(1.2 - (1.2**2 - 1.0) / (2.0 * 1.2))


def test_far_from_the_limit_it_is_mass_spring():
    """The scheme changes a cloth that no limit touches."""
    scene = Scene({
        **SPRINGS, 'rows': 6, 'cols': 5, 'dt': 0.004, 'start.jitter': 0.1, 'pushes.start': [0.05],
        'pushes.duration': [0.03], 'pushes.force': [0.0, 0.1, 0.5]})
    cloth, plain = PaperAdaptiveReference(scene, limit=5.0), MassSpringReference(scene)
    for _ in range(50):
        cloth.step()
        plain.step()
        assert not cloth.held().any()
    assert cloth.substeps == plain.substeps
    np.testing.assert_allclose(cloth.positions, plain.positions, atol=1e-11)
    np.testing.assert_allclose(cloth.velocities, plain.velocities, atol=1e-9)


def _momenta(cloth):
    mass = cloth.scene.node_mass
    return (mass * cloth.velocities.sum(axis=(0, 1)),
            mass * np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1)))


def test_momentum_at_the_limit():
    """What holds an edge does not act on both its ends alike, and along it."""
    cloth = PaperAdaptiveReference(Scene({
        'rows': 6, 'cols': 6, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0], 'dt': 0.002,
        'stiffness.structural': 5.0, 'stiffness.shear': 5.0, 'stiffness.bend': 0.5}))
    random = np.random.default_rng(5)
    cloth.velocities += random.normal(0.0, 1.0, cloth.positions.shape)
    cloth.velocities[..., 2] += 3.0 * cloth.positions[..., 0]
    before, held = _momenta(cloth), 0
    for _ in range(200):
        cloth.step()
        held += np.count_nonzero(cloth.held())
    assert held > 100
    after = _momenta(cloth)
    turned = np.abs(after[1] - before[1]).max() / np.linalg.norm(before[1])
    print(f'measured: angular momentum changed by {turned:.1e}')
    assert np.abs(after[0] - before[0]).max() < 1e-11 * np.linalg.norm(before[0])
    assert turned < 1e-11


def _run(dt, seconds=5.0):
    cloth = PaperAdaptiveReference(paper_scene(dt, 5, auto_substeps=False))
    strain = energy = 0.0
    for _ in range(round(seconds / dt)):
        cloth.step()
        strain = max(strain, cloth.max_strain())
        energy = max(energy, cloth.energies().kinetic)
    print(f'measured: dt {dt} max strain {strain:.3g} kinetic energy {energy:.3g} J')
    return strain, energy


def test_the_failure_of_the_paper():
    """The scheme does not blow up at dt = 0.02 s, or already does at 0.01 s."""
    strain, energy = _run(0.01)
    assert strain < 0.5
    assert energy < 1e4
    strain, energy = _run(0.02)
    assert strain > 10.0
    assert energy > 1e6


def test_a_short_step_fails_as_well():
    """Edges come back at some 0.1 L0 / dt: a shorter step would make the scheme calmer."""
    _, energy = _run(0.002, 1.3)
    assert energy > 1e6
