# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A recording of the recorder, small, with topics of several types."""

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.inputs import SetMode
from made_cloud import make_cloud
import pytest
from rclpy.serialization import serialize_message

FRAMES = 30
SIDE = 64


@pytest.fixture(scope='session')
def recorded(tmp_path_factory):
    """Return the folder of 30 frames at 50 Hz of 64 x 64 nodes that don't compress."""
    recorder = Recorder(tmp_path_factory.mktemp('recorded'), 'run', 'cloth_sim')
    key, mode = input_message(SetMode('adaptive'), 0.0, 'world')
    recorder.write(key, serialize_message(mode), 0.0)
    for number in range(FRAMES):
        time = number / 50
        recorder.write('points', make_cloud(SIDE, SIDE, number)[0], time)
        recorder.write('stats', serialize_message(ClothStats(steps=number)), time)
    recorder.close()
    return recorder.path
