# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Scenes of another size, under the same gravity, move alike (Froude's law of similarity).

With lengths times s, times are longer by the root of s, and masses times s^2, as the areal density
is the same. Stiffness then is s times as large, and damping s^1.5 times.
"""

import math

import numpy as np
import pytest

STRETCHED = {
    'mode': 'constraint', 'rows': 6, 'cols': 5, 'pins': ['top_left'], 'start.jitter': 0.02}
SUNK = {
    'mode': 'constraint', 'rows': 6, 'cols': 5, 'pins': ['none'], 'contact.thickness': 0.0,
    'colliders.names': ['floor'], 'colliders.floor.shape': 'plane',
    'colliders.floor.orientation': [0.0, 0.05, 0.0, 1.0]}


def moved(simulate, values, size, height, factor):
    """Return where nodes of a cloth are after a while, over its size."""
    time = math.sqrt(size)
    springs = {
        name: amount
        for family, share in (('structural', 1.0), ('shear', 1.0), ('bend', 0.1))
        for name, amount in (
            (f'stiffness.{family}', 100.0 * share * size),
            (f'damping.{family}', 0.01 * share * size * time))}
    cloth = simulate({
        **values, **springs, 'width': size, 'height': size, 'start.z': height * size,
        'dt': 0.005 * time})
    if factor != 1.0:
        cloth.set_state(factor * cloth.positions(), np.zeros_like(cloth.positions()))
    cloth.step(50)
    return cloth.positions() / size


@pytest.mark.parametrize('size', [1.0 / 16.0, 16.0])
def test_a_stretched_start_of_any_size(simulate, within, size):
    """A sail of 16 m was thrown together, as its limit closed in within 0.3 s."""
    usual = moved(simulate, STRETCHED, 1.0, 0.0, 1.1)
    found = moved(simulate, STRETCHED, size, 0.0, 1.1)
    within('distance over the size [1]', np.abs(found - usual).max(), 1e-6)


@pytest.mark.parametrize('size', [1.0 / 16.0, 16.0])
def test_a_sunk_start_of_any_size(simulate, within, size):
    """A sail of 16 m was moved out of the floor 4 times as slowly as it would fall."""
    usual = moved(simulate, SUNK, 1.0, -0.3, 1.0)
    found = moved(simulate, SUNK, size, -0.3, 1.0)
    within('distance over the size [1]', np.abs(found - usual).max(), 1e-6)
