# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Colours for strain."""

from cloth_sim_ros.messages.strain_colors import FULL_STRAIN
from cloth_sim_ros.messages.strain_colors import strain_colors
from matplotlib import colormaps
import numpy as np


def test_colours_are_those_of_viridis():
    """Equal steps of strain would not look equal."""
    strain = np.linspace(0.0, FULL_STRAIN, 101)
    np.testing.assert_allclose(
        strain_colors(strain), colormaps['viridis'](np.linspace(0.0, 1.0, 101)), atol=0.06)


def test_brightness_grows_with_strain():
    """A larger strain could look smaller, above all in grey."""
    brightness = strain_colors(np.linspace(0.0, FULL_STRAIN, 101))[:, :3] @ [0.299, 0.587, 0.114]
    assert np.all(np.diff(brightness) > 0.0)


def test_beyond_the_scale_is_the_last_colour():
    """A torn or broken cloth would show as one at rest."""
    colors = strain_colors(np.array([[FULL_STRAIN, 1.0], [np.inf, np.nan]], np.float32))
    assert colors.shape == (2, 2, 4) and colors.dtype == np.float32
    np.testing.assert_array_equal(colors, np.broadcast_to(colors[0, 0], (2, 2, 4)))
