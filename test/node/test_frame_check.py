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


"""The frame of a message from outside."""

from cloth_sim_ros.node.frame_check import check_frame
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


@pytest.mark.parametrize('frame', ['', 'world'])
def test_takes_its_own_frame(frame: str):
    """Points of the cloth's own frame would be refused."""
    check_frame(frame, 'world')


def test_refuses_another():
    """A point would be taken for another one, far away."""
    with pytest.raises(
            ClothSimError, match="is 'tool0' but the frame of the cloth is 'world': transform"):
        check_frame('tool0', 'world')
