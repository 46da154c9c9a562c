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

"""How still the force at the pins is."""

from cloth_sim_ros.study.force_tremor import SCENES
from cloth_sim_ros.study.force_tremor import tremor


def test_a_chain_that_is_solved_hangs_still():
    """The study would see a tremor where there is none, or take another force for the weight."""
    chain = next(iter(SCENES.values()))
    mean, deviation, moved = tremor(chain, 1.5)
    assert abs(mean - 1.0) < 1e-3
    assert deviation < 1e-3
    assert moved < 1e-5
