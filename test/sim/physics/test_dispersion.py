# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Longitudinal standing waves of a chain: the lattice's and the step's own frequency."""

from cloth_sim_ros.validation.waves import frequency
import pytest


@pytest.mark.parametrize(
    'layout', ['fused', pytest.param('paper', marks=pytest.mark.long)], indirect=True)
@pytest.mark.parametrize('wave', [1, 8, 24])
@pytest.mark.parametrize('dt', [0.004, 0.001])
def test_dispersion(context, within, mode, layout, wave, dt):
    """Waves do not run at Omega = (2 / dt) asin(omega dt / 2), omega = 2 sqrt(k/m) sin(q/2)."""
    found = frequency(context, mode, 33, wave, dt, layout=layout)
    within(f'dispersion, wave {wave}, dt {dt:g} s, relative',
           abs(found.value / found.most - 1.0), 5e-5)
