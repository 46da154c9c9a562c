# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""How much strain a colour means."""

from cloth_sim_ros.analysis.strain_scale import round_up
from cloth_sim_ros.analysis.strain_scale import StrainScale
import numpy as np
import pytest


@pytest.mark.parametrize('value, rounded', [
    (1.0, 1.0), (0.011, 0.02), (0.021, 0.05), (0.051, 0.1), (3e-4, 5e-4), (7.0, 10.0)])
def test_scales_end_at_round_numbers(value, rounded):
    """The colour bar would end at a number nobody can read."""
    assert round_up(value) == pytest.approx(rounded)


def test_all_frames_share_one_scale(hanging):
    """The same strain would have another colour in the next panel."""
    calm, wild = hanging(), hanging()
    wild.records['strain'] *= 10.0
    scale = StrainScale([calm, wild])
    assert scale.full == pytest.approx(0.5)
    assert scale.largest == pytest.approx(0.4)
    assert not scale.is_exceeded


def test_one_wild_node_does_not_hide_the_rest(hanging):
    """A single node at a pin would leave the whole cloth in the first colour."""
    frame = hanging(rows=40, cols=40)
    frame.records['strain'][0, 0] = 3.0
    scale = StrainScale([frame])
    assert scale.full == pytest.approx(0.05)
    assert scale.is_exceeded


def test_colors_are_those_of_the_bar(hanging):
    """The cloth would have colours that the bar explains otherwise."""
    scale = StrainScale([hanging()])
    np.testing.assert_allclose(
        scale.colors(np.array([0.02])), scale.in_percent.to_rgba([2.0]), atol=1e-2)


def test_a_cloth_at_rest_has_a_scale(hanging):
    """A cloth without any strain could not be drawn."""
    frame = hanging()
    frame.records['strain'] = 0.0
    assert StrainScale([frame]).full > 0.0
