# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record 50 messages, wait until they are flushed, record 50 more, and wait to be killed."""

import signal
import sys
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.recorder import Recorder
from rclpy.serialization import serialize_message
import yaml

recorder = Recorder(sys.argv[1], 'run')
for step in range(50):
    recorder.write('stats', serialize_message(ClothStats(steps=step)), step / 50)
flushed = 0
while flushed < 50:
    time.sleep(0.05)
    content = yaml.safe_load((recorder.path / 'metadata.yaml').read_text())
    flushed = content['rosbag2_bagfile_information']['message_count']
for step in range(50, 100):
    recorder.write('stats', serialize_message(ClothStats(steps=step)), step / 50)
print('flushed', flush=True)
signal.pause()
