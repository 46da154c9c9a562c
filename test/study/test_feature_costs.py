# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Variants are timed in turn, and compared with the whole scene."""

from cloth_sim_ros.study.cost import cost_table
from cloth_sim_ros.study.feature_costs import ALL_OUTPUTS
from cloth_sim_ros.study.feature_costs import compare_results
from cloth_sim_ros.study.feature_costs import list_passes
from cloth_sim_ros.study.feature_costs import NOTHING
from cloth_sim_ros.study.feature_costs import OUTPUTS
from cloth_sim_ros.study.feature_costs import time_variants
from cloth_sim_ros.study.feature_costs import WHOLE
import pytest
from springs import SPRINGS

SCENE = {**SPRINGS, 'rows': 8, 'cols': 8, 'dt': 0.005, 'pushes.start': [0.0],
         'pushes.duration': [0.05], 'pushes.force': [0.0, 0.0, 3.0]}


def test_all_variants_have_their_turns():
    """A ratio would be of other rounds, or of a variant that was not timed."""
    found = time_variants(
        SCENE, features=['damping', 'pushes', *OUTPUTS, ALL_OUTPUTS], outputs=OUTPUTS, rounds=3,
        round_seconds=0.04, frame_seconds=0.02)
    assert list(found['variants']) == [WHOLE, NOTHING, 'damping', 'pushes', *OUTPUTS, ALL_OUTPUTS]
    for name, variant in found['variants'].items():
        assert len(variant['ratios']) == 3 and min(variant['ratios']) > 0.0, name
    assert found['variants'][WHOLE]['ratios'] == [1.0, 1.0, 1.0]
    # Two frames without messages against two with all of them, and a recording.
    assert found['variants'][ALL_OUTPUTS]['processor_ratio'] < 1.0


def test_what_a_result_loses():
    """A feature would seem to be worth nothing, or a message to change the motion."""
    lost = compare_results(SCENE, feature='pushes', seconds=0.1)
    # 3 N for 0.05 s on 62 of 64 nodes of 0.2 kg in all: 0.77 m/s, for some 0.075 s.
    assert lost['rms_position'] == pytest.approx(0.058, rel=0.15)
    assert not lost['same_bits']
    same = compare_results(SCENE, feature='markers', seconds=0.1)
    assert same['same_bits'] and same['rms_position'] == 0.0 == same['strain_difference']


def test_the_table_has_all_rows():
    """A feature would be missing from the table."""
    timing = time_variants(
        SCENE, features=['damping'], outputs=[], rounds=1, round_seconds=0.02,
        frame_seconds=0.02)
    text = cost_table(timing, {'damping': compare_results(SCENE, feature='damping', seconds=0.1)},
                      ['mode'], 0.1, 'a device')
    assert '| damping |' in text and '| mode | not in this scene' in text and 'a device' in text


def test_passes_of_a_run_are_plain_values():
    """The list could not be kept as a line of JSON."""
    found = list_passes(SCENE, feature='pushes', seconds=0.02)
    assert found['steps'] == 4 and found['device']
    assert {'shader', 'defines', 'runs_per_step'} == set(found['passes'][0])
