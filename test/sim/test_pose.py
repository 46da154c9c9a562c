# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Positions and orientations of bodies."""

from cloth_sim_ros.sim.pose import rotated
from cloth_sim_ros.sim.pose import unit_quaternion
import numpy as np


def test_a_unit_quaternion_keeps_its_bits():
    """A recorded move would turn by other bits when it is made again."""
    generator = np.random.default_rng(3)
    for given in generator.normal(size=(2000, 4)):
        unit = unit_quaternion(given, 'it')
        assert unit_quaternion(unit, 'it') == unit
        np.testing.assert_allclose(unit, given / np.linalg.norm(given), rtol=1e-15)
        turned = rotated(unit, (0.6, 0.0, 0.8), float(given[0]))
        assert unit_quaternion(turned, 'it') == turned
