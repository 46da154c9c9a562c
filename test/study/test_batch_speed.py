# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The bench of many cloths."""

from cloth_sim_ros.study.batch_speed import measure_batch
import pytest


@pytest.mark.parametrize(('is_controlled', 'rounds'), [(False, 1), (True, 2)])
def test_both_ways_are_timed_in_each_round(is_controlled, rounds):
    """A speed-up would be computed from other rounds than it was measured in."""
    found = measure_batch(6, 3, is_controlled=is_controlled, frames=2, rounds=rounds)
    assert len(found.together) == len(found.one_by_one) == rounds
    assert found.ratios == [
        alone / batch for alone, batch in zip(found.one_by_one, found.together)]
    assert found.as_dict()['ratios'] == found.ratios and found.device
    assert '3 x (6 x 6)' in found.in_words()
