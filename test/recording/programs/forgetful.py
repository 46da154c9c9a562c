# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Record, then fail without closing."""

import sys

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.recorder import Recorder
from rclpy.serialization import serialize_message

recorder = Recorder(sys.argv[1], 'run')
for step in range(50):
    recorder.write('stats', serialize_message(ClothStats(steps=step)), step / 50)
raise SystemExit('something else went wrong')
