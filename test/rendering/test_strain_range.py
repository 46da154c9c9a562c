# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How much strain there is, without keeping it."""

from cloth_sim_ros.rendering.strain_range import StrainRange
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
