# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A towel that lies folded twice stays so, while nothing holds it."""

from cloth_sim_ros.validation.layers import THICKNESS
from crossings import crossings
from folded_towel import folded_twice
from folded_towel import TOWEL
import numpy as np
import pytest


@pytest.mark.long
def test_towel_folded_twice_stays_folded(simulate):
    """Layers would sink into each other or creep apart, or the folds open."""
    simulation = simulate(TOWEL)
    places = folded_twice()
    simulation.set_state(places, np.zeros_like(places))
    simulation.advance(10.0)
    begin = simulation.positions().astype(float)
    held = True
    for _ in range(25):
        simulation.advance(2.0)
        held &= simulation.snapshot().surface_contact_held
    places = simulation.positions().astype(float)
    drift = np.linalg.norm(places - begin, axis=-1)
    # Where all corners lie on each other; the loop of the outer fold lifts the uppermost.
    heights = np.sort(places[[1, 1, -2, -2], [1, -2, 1, -2], 2]) / THICKNESS
    print(f'drift in 50 s {drift.max():.1e} m, median {np.median(drift):.1e} m; layers at '
          f'{heights.round(4).tolist()} thicknesses')
    assert held and len(crossings(places)) == 0
    np.testing.assert_allclose(heights[:3], [0.5, 1.5, 2.5], atol=1e-3)
    assert 3.49 < heights[3] < 4.5
    assert np.median(drift) < 1e-5 and drift.max() < 2e-5
