# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The size of a panel when nobody says."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.panel_size import panel_size
import numpy as np
import pytest

FRONT = Camera(-90.0, 0.0)


@pytest.mark.parametrize(('wide', 'high', 'ratio'), [
    (1.0, 1.0, 1.0), (1.2, 1.0, 1.2), (1.0, 1.5, 1 / 1.5), (1.0, 0.0, 1.7), (0.0, 1.0, 1 / 1.7)])
def test_it_has_the_shape_of_the_scene(wide, high, ratio):
    """A panel would be half empty, or a finger wide."""
    corners = np.array([[0.0, 0.0, 0.0], [wide, 5.0, high]])
    width, height = panel_size(corners, FRONT)
    assert width / height == pytest.approx(ratio, rel=0.02)
    assert 300 < width < 700
