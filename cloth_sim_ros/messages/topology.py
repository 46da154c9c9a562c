# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
