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

"""The nodes on the device."""

from cloth_sim_ros.analysis.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.gl.errors import DeviceError
import numpy as np
import pytest


def test_a_cloth_too_large_for_the_device_is_refused(flat):
    """A part of it would be missing from the picture, silently."""
    with pytest.raises(DeviceError, match='9 x 9 nodes is too large.*at most 80 nodes'):
        NodeBuffer(161).load(flat(), np.zeros(3))
