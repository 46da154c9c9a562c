# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a tight limit costs on a shaken towel."""

import pytest
from shaken_towel import shake
from shaken_towel import TOWEL


@pytest.mark.parametrize('scheme', ['list', 'lattice', 'whole'])
def test_a_towel_at_its_limit_is_measured(scheme):
    """The benchmark would measure a towel that comes to no limit, or none that is shaken."""
    towel = shake(0.15, rows=6, cols=6, **{'adaptive.scheme': scheme})
    assert towel.median == pytest.approx(TOWEL['adaptive.threshold'], rel=0.3)
    assert towel.largest < 2.0 * TOWEL['adaptive.threshold']
    if scheme == 'whole':
        assert towel.whole > 0.5
        assert towel.solves >= 1.0
        assert towel.iterations > 0.0
    else:
        assert towel.listed > 0.5
        assert towel.whole == 0.0
        assert towel.rounds >= 1.0
    assert towel.seconds > 0.0
    still = shake(
        0.15, rows=6, cols=6, **{'adaptive.threshold': 0.5, 'adaptive.scheme': scheme})
    assert still.listed == still.whole == still.rounds == still.solves == 0.0


def test_limits_are_found_in_few_iterations():
    """Each pass would look for the limits in force anew, by what hair-fine lengths say of them."""
    towel = shake(0.25, rows=12, cols=12, **{'adaptive.scheme': 'whole'})
    iterations = towel.solves * towel.iterations
    print(f'measured {iterations:.1f} of 25 allowed: iterations in a substep, in '
          f'{towel.solves:.1f} solves')
    assert towel.unreached == 0.0
    # It is 31 if each pass starts from the limits by the lengths.
    assert iterations <= 25.0
