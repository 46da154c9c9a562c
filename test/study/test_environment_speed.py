# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The bench of environments."""

from cloth_sim_ros.study.environment_speed import measure_environments


def test_both_ways_are_timed_in_each_round():
    """A speed-up would be computed from other rounds than it was measured in."""
    found = measure_environments(4, 2, 3)
    assert len(found.together) == len(found.one_by_one) == 3
    assert found.as_dict()['ratios'] == [
        batch / alone for batch, alone in zip(found.together, found.one_by_one)]
    assert found.device and '2 environments of 4 x 4 nodes' in found.in_words()
