# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Errors are what their text says, on differences that are known."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.trade.errors import errors
from cloth_sim_ros.study.trade.path import Path
import numpy as np
import pytest
from springs import SPRINGS

TIMES, FRAMES = 3, 6


def test_known_differences():
    """A table would tell other errors than there are, or those of times that do not count."""
    scene = Scene({
        **SPRINGS, 'rows': 4, 'cols': 5, 'width': 2.0, 'height': 1.0, 'areal_density': 0.5})
    reference = Path(
        np.zeros((TIMES, 4, 5, 3)), np.full(FRAMES, 0.1), np.zeros((FRAMES, 3)))
    positions = np.zeros((TIMES, 4, 5, 3))
    positions[0, ..., 2], positions[1, ..., 0], positions[2] = 0.03, 0.04, 9.0
    strains = np.array([0.1, 0.13, 0.05, 0.1, 9.0, 9.0])
    energies = np.zeros((FRAMES, 3))
    energies[1] = 0.2, -0.5, 0.1
    energies[5] = 9.0
    found = errors(Path(positions, strains, energies), reference, scene, 2, 4)
    assert found.position == pytest.approx(np.sqrt((0.03**2 + 0.04**2) / 2.0) / 2.0)
    assert found.strain == pytest.approx(0.05)
    assert found.peak_strain == pytest.approx(0.13)
    assert found.energy == pytest.approx(0.2 / (0.5 * 2.0 * 9.81 * 2.0))
