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

"""The rest shape and its faces."""

from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.messages.triangles import triangles
from cloth_sim_ros.sim.scene import Scene


def serialise_topology(scene: Scene) -> bytes:
    """Return the CDR bytes of the shape_msgs/Mesh of ``scene`` at rest."""
    writer = CdrWriter()
    writer.put_sequence(triangles(scene.rows, scene.cols))
    writer.put_sequence(scene.rest_positions().reshape(-1, 3).astype('<f8', copy=False))
    return writer.finish()
