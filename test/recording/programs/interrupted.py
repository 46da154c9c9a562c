# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record faster than can be written, and close while interrupts come in."""

import os
import sys
from threading import Timer

from cloth_sim_ros.recording.recorder import Recorder
from rclpy.serialization import serialize_message
from sensor_msgs.msg import PointCloud2

recorder = Recorder(sys.argv[1], 'run')
data = serialize_message(PointCloud2(data=os.urandom(2**24)))
for step in range(12):
    recorder.write('points', data, step / 50)
# When it is closing: an interrupt just before is another matter.
Timer(0.1, print, ('closing',), {'flush': True}).start()
try:
    recorder.close()
except KeyboardInterrupt:
    print('interrupted', flush=True)
