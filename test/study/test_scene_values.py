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

"""The values of a scene make the same scene again."""

import json

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.scene_values import given_values
import pytest


@pytest.mark.parametrize('values', [
    {}, {'rows': 5, 'pins': ['none'], 'gravity': [0.0, 0.0, -1.0]},
    {'preset': 'fast'}, {'preset': 'accurate', 'dt': 0.005}])
def test_the_same_scene_again(values):
    """A study would run another scene than it was given."""
    scene = Scene(values)
    again = Scene(json.loads(json.dumps(given_values(scene))))
    assert {**again.values, 'preset': ''} == {**scene.values, 'preset': ''}


def test_defaults_are_left_out():
    """Each line of a study would repeat all parameters."""
    assert given_values(Scene({'rows': 32, 'cols': 7})) == {'cols': 7}
