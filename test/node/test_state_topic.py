# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the node says it is doing."""

from pathlib import Path
import time

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.srv import StartRecording
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.messages.stamp import nanoseconds
import pytest
from recorded import Recorded
from std_srvs.srv import Trigger


def stamp_of(message):
    """Return the stamp of the header [ns]."""
    return message.header.stamp.sec * 10**9 + message.header.stamp.nanosec


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
    told = cloth.wait_for('diagnostics', lambda message: any(
        status.message == 'paused' for status in message.status))
    assert all(status.name.startswith('cloth_sim: ') for status in told.status)
    assert any(simulation.device in status.message for status in told.status)


def test_diagnostics_carry_the_time_of_the_node(cloth):
    """An aggregator would take what comes from a paused or slow simulation for stale."""
    begin = time.time_ns()
    path = Path(cloth.call(StartRecording, 'start_recording', name='').path)
    assert cloth.call(Step, 'step', steps=4).success
    # The topic is everybody's: another node may be there, and knows nothing of this recording.
    told = cloth.wait_for('diagnostics', lambda message: (
        stamp_of(message) >= begin and str(path) in str(message.status)))
    assert stamp_of(told) <= time.time_ns()
    assert cloth.call(Trigger, 'stop_recording').success
    recorded = [
        (log_time, message) for topic, log_time, message in Recorded(path).entries
        if topic == '/diagnostics']
    assert recorded and all(stamp_of(message) >= begin for _, message in recorded)
    assert {log_time for log_time, _ in recorded} <= {0, nanoseconds(4 * cloth.dt)}
