# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Rings around pushed regions."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.region_rings import region_rings
from cloth_sim_ros.sim.push import Push
import numpy as np


def test_the_ring_is_the_outline_of_the_sphere():
    """A reader would see another region than the one that is pushed."""
    axes = Camera(20.0, 40.0).axes
    whole = Push.checked(force=(0.0, 0.0, 1.0), start=0.0, duration=1.0)
    part = Push.checked(
        force=(0.0, 0.0, 1.0), start=0.0, duration=1.0, region='sphere', center=(1.0, 2.0, 3.0),
        radius=0.5)
    ring, = region_rings([whole, part], axes)
    away = ring - part.center
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 0.5)
    np.testing.assert_allclose(away @ axes[2], 0.0, atol=1e-12)
    np.testing.assert_allclose(ring[0], ring[-1])
