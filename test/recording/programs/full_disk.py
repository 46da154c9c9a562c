# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record into files that can't grow beyond 4 MiB, and print the outcome."""

import os
import resource
import sys
import time

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.recording.recording_faults import RecordingError
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2
import yaml

limit = 4 * 2**20
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
recorder = Recorder(sys.argv[1], 'run')
recorder.write('stats', serialize_message(ClothStats(steps=1)), 0.0)
flushed = 0
while flushed < 1:
    time.sleep(0.05)
    content = yaml.safe_load((recorder.path / 'metadata.yaml').read_text())
    flushed = content['rosbag2_bagfile_information']['message_count']
errors = []
step, left = 0, 20  # tries after the first error
while left > 0:
    try:
        recorder.write(
            'points', serialize_message(PointCloud2(data=os.urandom(2**18))), step / 50)
    except RecordingError as error:
        errors.append(str(error))
    step += 1
    left -= bool(errors)
    time.sleep(0.001)
recorder.close()
recorder.close()
print(len(errors), *errors, sep='\n')
