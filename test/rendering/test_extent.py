# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far the scene reaches."""

from cloth_sim_ros.rendering.extent import Extent
import numpy as np


def test_it_keeps_what_reaches_farthest():
    """The camera would cut off a corner of the cloth in some frame."""
    random = np.random.default_rng(0)
    clouds = [random.normal(size=(50, 60, 3)) + shift for shift in (0.0, 3.0, -1.0)]
    extent = Extent()
    for cloud in clouds:
        extent.add(cloud)
    points = np.concatenate(clouds).reshape(-1, 3)
    np.testing.assert_array_equal(extent.low, points.min(axis=0))
    np.testing.assert_array_equal(extent.high, points.max(axis=0))
    assert extent.size == np.ptp(points, axis=0).max()
    # From any side, all but a sliver is within what was kept.
    sides = random.normal(size=(200, 3))
    sides /= np.linalg.norm(sides, axis=1, keepdims=True)
    missed = (points @ sides.T).max(axis=0) - (extent.points @ sides.T).max(axis=0)
    assert missed.max() < 0.03 * extent.size
    assert len(extent.points) < 300


def test_of_a_fine_cloth_the_corners_are_looked_at():
    """A corner that flies off would be outside the picture."""
    positions = np.zeros((301, 517, 3))
    positions[-1, -1] = (7.0, 8.0, 9.0)
    extent = Extent()
    extent.add_nodes(positions)
    np.testing.assert_array_equal(extent.high, [7.0, 8.0, 9.0])


def test_what_is_not_finite_is_left_out():
    """One lost node would leave the whole picture without a camera."""
    points = np.array([[0.0, 0.0, 0.0], [np.nan, 1.0, 1.0], [1.0, np.inf, 1.0], [1.0, 2.0, 3.0]])
    extent = Extent()
    extent.add(points)
    np.testing.assert_array_equal(extent.high, [1.0, 2.0, 3.0])
