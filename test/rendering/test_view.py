# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The formulas of the view agree with what OpenGL makes of its matrix."""

from cloth_sim_ros.rendering.camera import Camera
import numpy as np
import pytest


@pytest.mark.parametrize('field_of_view', [0.0, 25.0, 90.0])
def test_the_matrix_puts_points_where_project_says(field_of_view):
    """Words and marks would stand beside what they belong to."""
    points = np.random.default_rng(0).uniform(-1.0, 1.0, (30, 3)) + (5.0, 0.0, -2.0)
    view = Camera(30.0, 15.0, field_of_view, zoom=1.3).looking_at(points, 320, 240)
    clip = np.append(points - view.middle, np.ones((30, 1)), axis=1) @ view.matrix.T
    device = clip[:, :3] / clip[:, 3:]
    pixels = (device[:, :2] * (1.0, -1.0) + 1.0) / 2.0 * (320.0, 240.0)
    np.testing.assert_allclose(pixels, view.project(points))
    # All of it lies between the near and the far end, and what is nearer comes first.
    assert (np.abs(device[:, 2]) < 1.0).all()
    near = (points - view.middle) @ view.axes[2]
    assert (np.diff(device[np.argsort(-near), 2]) > 0.0).all()
