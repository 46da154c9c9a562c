# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The force beside its arrow."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.push_words import write_forces
from cloth_sim_ros.sim.push import Push
import numpy as np
import pytest


@pytest.mark.parametrize('force', [
    (0.0, 0.0, 5.0), (5.0, 0.0, 0.0), (-3.0, 0.0, -4.0), (0.0, -5.0, 0.0)])
def test_it_stands_beyond_the_tip(force):
    """The words would cover the arrow, or have no place where it points to the camera."""
    corners = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    view = Camera(-90.0, 0.0, 0.0).looking_at(corners, 300, 300)
    arrow = np.array([(0.0, 0.0, 0.0), np.array(force) / 10.0])
    image = np.full((300, 300, 3), 255, np.uint8)
    push = Push.checked(force=force, start=0.0, duration=1.0)
    write_forces(image, [push], [arrow], view, 14)
    ink = np.argwhere((image < 200).any(axis=-1))[:, ::-1]
    tail, tip = view.project(arrow)
    assert len(ink) > 30
    assert np.linalg.norm(ink - tip, axis=1).min() > 1.0
    assert np.linalg.norm(ink.mean(axis=0) - tip) < 45.0
    if force[0] or force[2]:
        assert (ink.mean(axis=0) - tip) @ (tip - tail) > 0.0
