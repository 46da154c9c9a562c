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

"""What the node says it is doing."""

from cloth_sim_interfaces.msg import ClothState
import pytest


def test_state_is_kept_for_those_who_come_late(cloth, simulation):
    """A tool that starts after the node would not learn its grid, device or run state."""
    state = cloth.client.read_kept(ClothState, f'{cloth.name}/state')
    assert (state.mode, state.run_state) == ('mass_spring', 'paused')
    assert (state.rows, state.cols, state.dt) == (8, 10, 0.005)
    assert state.substeps == simulation.substeps
    assert state.stability_limit == pytest.approx(simulation.stability_limit, rel=1e-12)
    assert state.device == simulation.device
    assert list(state.available_modes) == list(simulation.available_modes)
    assert (state.recording, state.recording_path) == (False, '')


def test_diagnostics_tell_device_and_pace(cloth, simulation):
    """A monitor of /diagnostics would not see the node."""
    told = cloth.wait_for('diagnostics')
    assert all(status.name.startswith('cloth_sim: ') for status in told.status)
    assert any(simulation.device in status.message for status in told.status)
    assert any(status.message == 'paused' for status in told.status)
