# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The bench of layers that touch."""

from cloth_sim_ros.study.self_contact_speed import measure_layers
import pytest


@pytest.mark.parametrize('pose', ['flat', 'folded'])
def test_only_layers_of_a_folded_towel_touch(pose):
    """The cost of contact would be that of a towel which never touches itself."""
    found = measure_layers(pose, 'mass_spring', 24, settle=0.06, seconds=0.002, rounds=2)
    assert len(found.without) == len(found.touching) == 2
    assert (found.contacts > 0) == (pose == 'folded')
    assert found.ratios == [
        touching / alone for touching, alone in zip(found.touching, found.without)]
    assert found.as_dict()['ratios'] == found.ratios and found.device
    assert f'24 x 24, {pose}, mass_spring' in found.in_words()
