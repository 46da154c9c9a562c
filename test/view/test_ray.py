# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A ray meets the cloth where geometry says."""

from cloth_sim_ros.messages.geometry import triangles
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view.ray import first_hit
import numpy as np
import pytest

FLAT = Scene({'rows': 5, 'cols': 9, 'width': 0.8, 'height': 0.4, 'start.z': 1.0}).rest_positions()
POINTS, FACES = FLAT.reshape(-1, 3), triangles(5, 9)


@pytest.mark.parametrize('height', [3.0, -2.0])
def test_a_ray_meets_a_level_cloth_in_its_plane(height: float):
    """A push would act beside the point that was clicked, or only on the upper side."""
    origin, target = np.array((0.7, -0.4, height)), np.array((0.13, 0.07, 1.0))
    hit = first_hit(origin, 3.0 * (target - origin), POINTS, FACES)
    np.testing.assert_allclose(hit.point, target, atol=1e-12)
    nearest = int(np.argmin(np.linalg.norm(POINTS - target, axis=1)))
    assert hit.node == nearest


@pytest.mark.parametrize(('origin', 'direction'), [
    ((0.0, 0.0, 3.0), (0.0, 0.0, 1.0)), ((0.5, 0.0, 3.0), (0.0, 0.0, -1.0)),
    ((-3.0, 0.0, 1.0), (1.0, 0.0, 0.0)), ((0.0, 0.0, 3.0), (0.0, 0.0, 0.0))],
    ids=['behind', 'beside', 'within its plane', 'no direction'])
def test_a_ray_past_the_cloth_meets_nothing(origin: tuple, direction: tuple):
    """A click on the background would push the cloth."""
    assert first_hit(origin, direction, POINTS, FACES) is None


def test_the_nearest_of_two_layers_is_met():
    """A click on a folded cloth would push the layer behind."""
    both = np.concatenate([POINTS, POINTS + (0.0, 0.0, 0.5)])
    faces = np.concatenate([FACES, FACES + len(POINTS)])
    hit = first_hit((0.01, 0.02, 3.0), (0.0, 0.0, -1.0), both, faces)
    assert hit.point[2] == pytest.approx(1.5) and hit.node >= len(POINTS)


def test_a_chain_has_no_surface_to_meet():
    """A view of a chain would end with the first click."""
    assert first_hit((0.0, 0.0, 3.0), (0.0, 0.0, -1.0), POINTS[:3], triangles(1, 3)) is None
