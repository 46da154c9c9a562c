# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Balls are drawn where pins are."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.solid_drawing import ball_radius
import numpy as np
import pytest

VIEW = Camera().looking_at(np.eye(3), 600, 450)


def test_few_balls_have_a_fixed_size():
    """Two pins close together would be specks."""
    two = np.array([[10.0, 10.0], [11.0, 10.0]])
    assert ball_radius(two, VIEW) == ball_radius(two[:1], VIEW) == pytest.approx(6.0)


def test_many_balls_leave_room_between_them():
    """The pins of an edge would cover the cloth."""
    row = np.stack([np.arange(50) * 8.0, np.zeros(50)], axis=1)
    assert 2.0 * ball_radius(row, VIEW) < 8.0
    assert ball_radius(0.01 * row, VIEW) > 1.0
    assert ball_radius(10.0 * row, VIEW) == pytest.approx(6.0)
