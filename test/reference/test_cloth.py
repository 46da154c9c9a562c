# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The oracle's energies against numbers worked out by hand."""

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest


def _chain():
    return MassSpringReference(Scene({
        'rows': 3, 'cols': 1, 'height': 2.0, 'node_mass': 0.5, 'pins': ['top_left'],
        'start.pose': 'hanging', 'start.z': 5.0, 'gravity': [0.0, 0.0, -10.0],
        'stiffness.structural': 8.0, 'stiffness.bend': 3.0}))


def test_energies_of_a_stretched_chain():
    """One of the three energies is not 1/2 m v^2, 1/2 k (l - L0)^2 or m g z."""
    chain = _chain()
    chain.positions[:, 0, 2] = [6.0, 4.9, 3.7]
    chain.velocities[1, 0] = [3.0, 0.0, 4.0]
    energies = chain.energies()
    assert energies.kinetic == pytest.approx(0.25 * 25.0)
    assert energies.elastic == pytest.approx(4.0 * (0.1**2 + 0.2**2) + 1.5 * 0.3**2)
    assert energies.gravitational == pytest.approx(0.5 * 10.0 * (6.0 + 4.9 + 3.7))
    assert energies.total == pytest.approx(
        energies.kinetic + energies.elastic + energies.gravitational)


def test_pinned_nodes_have_no_kinetic_energy():
    """A velocity left at a pin is counted as motion."""
    chain = _chain()
    chain.velocities[0, 0] = [1.0, 2.0, 3.0]
    assert chain.energies().kinetic == 0.0


def test_strain_is_the_largest_at_each_node():
    """A node's strain leaves out a spring, takes in the bend springs or keeps the sign."""
    chain = _chain()
    chain.positions[:, 0, 2] = [6.0, 5.3, 4.2]
    np.testing.assert_allclose(chain.node_strain()[:, 0], [0.3, 0.3, 0.1], atol=1e-12)
