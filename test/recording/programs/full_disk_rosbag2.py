# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record by rosbag2_py into files that can't grow beyond 1 MiB, and print the outcome."""

import os
import resource
import sys

from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.recording.recording_faults import RecordingError
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2

limit = 2**20
resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
recorder = Recorder(sys.argv[1], 'run', library='rosbag2_py')
try:
    for number in range(8):
        recorder.write(
            'points', serialize_message(PointCloud2(data=os.urandom(2**18))), number / 50)
    recorder.close()
except RecordingError as error:
    print(error)
