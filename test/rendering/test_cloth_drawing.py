# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The shape of a cell, which keeps dots round."""

from cloth_sim_ros.rendering.cloth_drawing import cell_sides
import numpy as np
import pytest


def lattice(width, height):
    """Return the positions of a flat cloth with cells of this size."""
    positions = np.zeros((5, 7, 3))
    positions[..., 0] = np.arange(7) * width
    positions[..., 1] = np.arange(5)[:, None] * height
    return positions


@pytest.mark.parametrize(('width', 'height', 'sides'), [
    (0.1, 0.1, (1.0, 1.0)), (0.3, 0.1, (3.0, 1.0)), (0.1, 0.2, (1.0, 2.0)), (0, 0, (1.0, 1.0))])
def test_it_is_that_of_the_cloth(width, height, sides):
    """Dots would be ellipses, or a cloth in one point divide by zero."""
    assert cell_sides(lattice(width, height)) == pytest.approx(sides)
