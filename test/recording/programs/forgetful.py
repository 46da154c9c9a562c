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

"""Record, then fail without closing."""

import sys

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.recording.recorder import Recorder
from rclpy.serialization import serialize_message

recorder = Recorder(sys.argv[1], 'run')
for step in range(50):
    recorder.write('stats', serialize_message(ClothStats(steps=step)), step / 50)
raise SystemExit('something else went wrong')
