# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
