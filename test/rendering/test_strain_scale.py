# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours of strain and their range are those of the frames."""

from cloth_sim_ros.rendering.strain_scale import PALETTE_SIZE
from cloth_sim_ros.rendering.strain_scale import round_up
from cloth_sim_ros.rendering.strain_scale import StrainRange
from cloth_sim_ros.rendering.strain_scale import StrainScale
from cloth_sim_ros.sim.errors import ClothSimError
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
