# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours, sizes, light and lettering of all pictures, and the colours of strain."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.look import force_words
from cloth_sim_ros.rendering.look import PALETTE_SIZE
from cloth_sim_ros.rendering.look import round_up
from cloth_sim_ros.rendering.look import StrainRange
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.look import write_forces
from cloth_sim_ros.rendering.look import write_words
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
import numpy as np
import pytest


def test_shares_are_those_of_all_frames_together():
    """The colours would fit one frame and not the others."""
    random = np.random.default_rng(0)
    frames = [random.gamma(2.0, scale, (40, 50)) for scale in (0.001, 0.02, 0.005)]
    strains = StrainRange()
    for frame in frames:
        strains.add(frame)
    for share in (0.5, 0.9, 0.995):
        assert strains.above(share) == pytest.approx(np.quantile(frames, share), rel=0.02)
    assert strains.largest == np.max(frames)


def test_unknown_strain_counts_for_nothing():
    """A state without strain would be coloured as if it had none."""
    strains = StrainRange()
    strains.add(np.full((3, 4), np.nan))
    assert not strains.is_known
    strains.add(np.array([[0.25, np.nan]]))
    assert strains.is_known and strains.largest == 0.25


def test_a_cloth_at_rest_has_no_strain():
    """Its logarithm would be looked for."""
    strains = StrainRange()
    strains.add(np.zeros((3, 4)))
    assert strains.above(0.995) == 0.0 and strains.largest == 0.0


def scale_of(*frames, full=None):
    """Return the scale for some frames."""
    strains = StrainRange()
    for frame in frames:
        strains.add(frame.strain)
    return StrainScale(strains, full)


@pytest.mark.parametrize('value, rounded', [
    (1.0, 1.0), (0.011, 0.02), (0.021, 0.05), (0.051, 0.1), (3e-4, 5e-4), (7.0, 10.0)])
def test_scales_end_at_round_numbers(value, rounded):
    """The colour bar would end at a number nobody can read."""
    assert round_up(value) == pytest.approx(rounded)


def test_all_frames_share_one_scale(hanging):
    """The same strain would have another colour in the next panel."""
    calm, wild = hanging(), hanging()
    wild.records['strain'] *= 10.0
    scale = scale_of(calm, wild)
    assert scale.full == pytest.approx(0.5)
    assert scale.largest == pytest.approx(0.4)
    assert not scale.is_exceeded


def test_one_wild_node_does_not_hide_the_rest(hanging):
    """A single node at a pin would leave the whole cloth in the first colour."""
    frame = hanging(rows=40, cols=40)
    frame.records['strain'][0, 0] = 3.0
    scale = scale_of(frame)
    assert scale.full == pytest.approx(0.05)
    assert scale.is_exceeded


def test_colors_are_those_of_the_bar(hanging):
    """The cloth would have colours that the bar explains otherwise."""
    scale = scale_of(hanging())
    np.testing.assert_allclose(
        scale.colors(np.array([0.02])), scale.in_percent.to_rgba([2.0]), atol=1e-2)


def test_a_cloth_at_rest_has_a_scale(hanging):
    """A cloth without any strain could not be drawn."""
    frame = hanging()
    frame.records['strain'] = 0.0
    assert scale_of(frame).full > 0.0


def test_the_palette_is_that_of_the_bar(hanging):
    """The shaders would draw other colours than the bar shows."""
    scale = scale_of(hanging())
    assert scale.palette.shape == (PALETTE_SIZE, 4)
    middles = (np.arange(PALETTE_SIZE) + 0.5) / PALETTE_SIZE
    np.testing.assert_allclose(
        scale.palette, scale.in_percent.to_rgba(100.0 * scale.full * middles), atol=1e-6)


def test_the_scale_can_be_set(hanging):
    """Two pictures could not be made comparable."""
    scale = scale_of(hanging(), full=0.03)
    assert scale.full == 0.03 and scale.is_exceeded
    assert scale.in_percent.norm.vmax == pytest.approx(3.0)


@pytest.mark.parametrize('wrong', [0.0, -1.0, float('nan'), float('inf')])
def test_a_scale_without_colours_is_refused(hanging, wrong):
    """The cloth would be drawn in one colour."""
    with pytest.raises(ClothSimError, match='must be above 0'):
        scale_of(hanging(), full=wrong)


# Words and forces stand where they can be read.


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


def test_it_stands_behind_the_tail_at_a_border():
    """The words would cover the tip of an arrow that ends at the border of a panel."""
    corners = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    view = Camera(-90.0, 0.0, 0.0).looking_at(corners, 300, 300)
    arrow = np.array([(0.0, 0.0, 0.6), (0.0, 0.0, 1.04)])
    image = np.full((300, 300, 3), 255, np.uint8)
    push = Push.checked(force=(0.0, 0.0, 6970.0), start=0.0, duration=1.0)
    write_forces(image, [push], [arrow], view, 14)
    ink = np.argwhere((image < 200).any(axis=-1))[:, ::-1]
    tail, _ = view.project(arrow)
    assert len(ink) > 30
    assert 1.0 < ink[:, 1].min() - tail[1] < 14.0


@pytest.mark.parametrize(('force', 'words'), [
    (0.0123456, '0.0123 N'), (12.0, '12 N'), (6967.4, '6970 N'), (123456.0, '123000 N')])
def test_forces_are_written_without_exponents(force, words):
    """A reader would have to work out how large 6.97e+03 N is."""
    assert force_words(force) == words
