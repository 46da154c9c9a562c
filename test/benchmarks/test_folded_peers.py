# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The folded towel starts as it should in each simulator that is there."""

from folded_peers import folded
from folded_peers import Here
from folded_peers import layers_of
from folded_peers import MuJoCo
from folded_peers import SIDE
import numpy as np
import pytest

NODES = 16
CELL = SIDE / (NODES - 1)
THICKNESS = 0.25 * CELL


def test_the_fold_keeps_lengths():
    """A towel that starts with a part of its length would be thrown open."""
    places = folded(NODES, THICKNESS)
    for axis in (0, 1):
        lengths = np.linalg.norm(np.diff(places, axis=axis), axis=-1)
        np.testing.assert_allclose(lengths, CELL, rtol=0.2)
    assert places[..., 2].min() == pytest.approx(0.5 * THICKNESS)


def test_layers_come_to_rest_on_each_other():
    """Creep would be measured on a towel that has opened, or slides."""
    towel = Here(NODES, THICKNESS)
    towel.advance(1.0)
    before = layers_of(towel)
    towel.advance(1.1)
    after = layers_of(towel)
    assert (after[1] - after[0])[2] == pytest.approx(THICKNESS, rel=0.02)
    assert np.abs(np.subtract(after, before)).max() < 1e-5


def test_the_flex_starts_folded():
    """The peer would start flat, or somewhere else."""
    pytest.importorskip('mujoco', reason='needs `pip install mujoco`, which the peer is')
    towel = MuJoCo(NODES, THICKNESS, 0.001, 'disable')
    np.testing.assert_allclose(towel.positions(), folded(NODES, THICKNESS), atol=1e-6)
