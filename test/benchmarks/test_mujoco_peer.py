# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The comparison with MuJoCo measures what it says; its own part runs where that is installed."""

from cloth_sim_ros.gl.context import Context
from mujoco_peer import Cloth
from mujoco_peer import compare
from mujoco_peer import falling
from mujoco_peer import HEIGHT
from mujoco_peer import MASS
from mujoco_peer import MODES
from mujoco_peer import SIDE
from mujoco_peer import stretch
import numpy as np
import pytest

NODES = 6


def level():
    """Return the nodes of a level sheet, (n, n, 3) [m]."""
    along = np.linspace(-SIDE / 2.0, SIDE / 2.0, NODES)
    x, y = np.meshgrid(along, along)
    return np.stack([x, y, np.full_like(x, HEIGHT)], axis=-1)


def test_stretch_is_that_of_the_threads():
    """One of the simulators would be held to another stretch."""
    assert np.abs(stretch(level())).max() < 1e-12
    found = stretch(level() * (1.02, 0.99, 1.0))
    assert len(found) == 2 * NODES * (NODES - 1)
    np.testing.assert_allclose(np.unique(found.round(9)), [-0.01, 0.02])


def test_the_sheets_here_fall_over_the_sphere():
    """The table would compare a sheet that falls past the sphere, or is inside it."""
    context = Context(single_thread=True)
    rows = list(compare(
        {name: Cloth(NODES, values, context) for name, values in MODES.items()}, 0.3))
    context.close()
    assert len(rows) == len(MODES)
    for row in rows:
        _, name, wall, peak, usual, deepest, _ = row.split('|')
        assert name.strip() in MODES and float(wall) > 0.0
        assert 0.0 <= float(usual) <= float(peak) < 10.0 and float(peak) > 0.0
        assert float(deepest) < 0.002


def test_the_flex_is_the_same_sheet():
    """The peer would have another mass, or start somewhere else."""
    pytest.importorskip('mujoco', reason='needs `pip install mujoco`, which the peer is')
    flex = falling(NODES, 0.001)
    assert flex._model.body_mass.sum() == pytest.approx(MASS)
    flex.advance(0.05)
    positions = flex.positions()
    # It falls freely, with velocities of the end of each step.
    fallen = 0.5 * 9.81 * 0.05 * 0.051
    np.testing.assert_allclose(
        np.sort(positions.reshape(-1, 3), axis=0),
        np.sort(level().reshape(-1, 3) - (0.0, 0.0, fallen), axis=0), atol=1e-4)
