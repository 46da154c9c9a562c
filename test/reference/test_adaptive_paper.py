# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The paper's adaptive scheme: springs, momentum, and the failure the paper reports."""

from cloth_sim_ros.reference.adaptive_paper import PaperAdaptiveReference
from cloth_sim_ros.reference.mass_spring import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
from limit_scenes import paper_scene
import numpy as np
import pytest
from springs import SPRINGS


def test_an_edge_beyond_the_limit_goes_to_rest_length_at_once():
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
