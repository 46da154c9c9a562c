# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What can be asked of the player."""

from cloth_sim_ros.playback.schedule import PlayOptions
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


@pytest.mark.parametrize('wrong', [
    {'rate': 0.0}, {'rate': -1.0}, {'rate': float('nan')}, {'rate': float('inf')},
    {'start': -0.1}, {'duration': -1.0}, {'delay': float('nan')}])
def test_numbers_outside_their_range_are_refused(wrong):
    """Playing would hang, or run backwards."""
    name, = wrong
    with pytest.raises(ClothSimError, match=f'--{name} .* is outside its range: give a value'):
        PlayOptions(**wrong)


@pytest.mark.parametrize(('topic', 'played'), [
    ('/cloth_sim/points', '/b/cloth/points'),
    ('/cloth_sim/pins/wrenches', '/b/cloth/pins/wrenches'),
    ('/diagnostics', '/diagnostics'), ('/cloth_sim_2/points', '/cloth_sim_2/points')])
def test_topics_of_the_node_get_the_other_name(topic, played):
    """Another node's topics would be renamed, or this one's left."""
    assert PlayOptions(played_node='b/cloth').played_name(topic) == played
    assert PlayOptions().played_name(topic) == topic
