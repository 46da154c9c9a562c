# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a run is from its reference, and how near its model came to one."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.trade.accuracy import distances
from cloth_sim_ros.study.trade.accuracy import errors
from cloth_sim_ros.study.trade.accuracy import Path
import numpy as np
import pytest
from springs import SPRINGS


def plane(rows, cols, lift=0.0):
    """Return the path of a flat cloth that leans, at two times."""
    v, u = np.meshgrid(np.linspace(0, 1, rows), np.linspace(0, 1, cols), indexing='ij')
    positions = np.stack([u, v, 2.0 * u - 3.0 * v + lift], axis=-1)
    return Path(np.stack([positions, positions]), np.zeros(2), np.zeros((2, 3)))


@pytest.mark.parametrize('rows, cols', [(4, 9), (12, 3), (1, 5), (7, 7)])
def test_a_plane_is_the_same_at_any_resolution(rows, cols):
    """Nodes would be compared with points elsewhere on the cloth."""
    target = plane(7, 7)
    if rows > 1:
        assert distances(plane(rows, cols).on_nodes_of(7, 7), target).max() < 1e-12
    assert plane(7, 7).on_nodes_of(rows, cols).positions.shape == (2, rows, cols, 3)


def test_distance_is_that_of_the_same_nodes():
    """A shifted cloth would seem nearer or farther than it is."""
    assert distances(plane(5, 6, lift=0.25), plane(5, 6)) == pytest.approx([0.25, 0.25])


# Errors are what their text says, on differences that are known.

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
