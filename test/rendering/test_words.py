# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Words and forces stand where they can be read."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.words import write_forces
from cloth_sim_ros.rendering.words import write_words
from cloth_sim_ros.sim.push import Push
import numpy as np
import pytest


def written(text, place, size=14, **look):
    """Return the pixels that words change in a grey image."""
    image = np.full((80, 120, 3), 128, np.uint8)
    write_words(image, text, place, size, **look)
    return image, (image != 128).any(axis=-1)


def test_they_are_around_their_place():
    """A heading would stand over another panel."""
    image, changed = written('t = 1', (60.0, 40.0))
    np.testing.assert_allclose(np.argwhere(changed).mean(axis=0), [40.0, 60.0], atol=4.0)
    assert image.min() < 60 and image.max() > 240  # ink and halo


@pytest.mark.parametrize('place', [(-50.0, -50.0), (500.0, 40.0), (60.0, 300.0), (1.0, 79.0)])
def test_words_outside_are_moved_in(place):
    """The force of a push near the border would be cut off."""
    middle = written('12 N', (60.0, 40.0))[1].sum()
    assert written('12 N', place)[1].sum() == pytest.approx(middle, rel=0.05)


def test_colour_and_weight_are_those_asked_for():
    """The force would not be seen to belong to its arrow."""
    image, changed = written('12 N', (60.0, 40.0), 20, color=(20, 90, 220), is_bold=True)
    blue = (image[..., 2].astype(int) - image[..., 0]) > 120
    assert blue.sum() > 30
    assert blue.sum() > (written('12 N', (60.0, 40.0), 20)[0] < 60).all(axis=-1).sum()


def test_words_wider_than_the_image_are_no_failure():
    """A picture with small panels and long labels could not be made."""
    assert written('a label that is far too long for this', (60.0, 40.0), 30)[1].any()


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
