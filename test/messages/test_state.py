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

"""What the simulation is doing."""

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_ros.messages.state import state_message
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message

CONTENT = {
    'mode': 'mass_spring', 'run_state': ClothState.PAUSED, 'rows': 5, 'cols': 7, 'dt': 0.005,
    'substeps': 3, 'stability_limit': 0.01, 'device': 'llvmpipe'}


@pytest.mark.parametrize(('path', 'recording'), [('', False), ('/bags/a', True)])
def test_every_value_is_in_its_place(path, recording):
    """A tool would show one value under the name of another."""
    message = state_message(
        **CONTENT, frame_id='world', sim_time=2.5, available_modes=('mass_spring',),
        recording_path=path)
    state = deserialize_message(serialize_message(message), ClothState)
    assert {name: getattr(state, name) for name in CONTENT} == CONTENT
    assert state.available_modes == ['mass_spring']
    assert (state.recording, state.recording_path) == (recording, path)
    assert (state.header.stamp.sec, state.header.stamp.nanosec) == (2, 500000000)
    assert state.header.frame_id == 'world'
