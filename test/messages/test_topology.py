# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The rest shape, decoded."""

from cloth_sim_ros.messages.topology import serialise_topology
from cloth_sim_ros.messages.triangles import triangles
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from shape_msgs.msg import Mesh


@pytest.mark.parametrize(('rows', 'cols', 'pose'), [
    (3, 5, 'horizontal'), (4, 2, 'hanging'), (1, 6, 'hanging')])
def test_mesh_is_the_scene_at_rest(rows, cols, pose):
    """A viewer would draw another cloth than the one simulated."""
    scene = Scene({'rows': rows, 'cols': cols, 'start.pose': pose, 'start.jitter': 0.2})
    mesh = deserialize_message(serialise_topology(scene), Mesh)
    nodes = np.array([[node.x, node.y, node.z] for node in mesh.vertices])
    np.testing.assert_array_equal(nodes, scene.rest_positions().reshape(-1, 3))
    faces = np.array([face.vertex_indices for face in mesh.triangles]).reshape(-1, 3)
    np.testing.assert_array_equal(faces, triangles(rows, cols))
