# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""CDR written by hand, read by ROS."""

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.cdr_writer import CdrWriter
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Imu
from shape_msgs.msg import Mesh
from std_msgs.msg import Header


@pytest.mark.parametrize('frame_id', ['', 'a', 'ab', 'abc', 'abcd', 'Tür'])
def test_alignment_follows_strings(frame_id):
    """Numbers behind a string would be read from the wrong place."""
    writer = CdrWriter()
    writer.put('i', 3)
    writer.put('I', 4)
    writer.put_string(frame_id)
    writer.put('d', *(float(value) for value in range(1, 38)))
    imu = deserialize_message(writer.finish(), Imu)
    assert imu.header == Header(stamp=Time(sec=3, nanosec=4), frame_id=frame_id)
    assert (imu.orientation.x, imu.orientation.w) == (1.0, 4.0)
    assert imu.orientation_covariance[8] == 13.0
    assert imu.linear_acceleration_covariance[8] == 37.0


@pytest.mark.parametrize(('faces', 'nodes'), [(0, 0), (1, 0), (0, 2), (3, 4)])
def test_sequences_of_rows(faces, nodes):
    """Points behind a sequence of any length would be shifted."""
    triangles = np.arange(3 * faces, dtype='<u4').reshape(faces, 3)
    vertices = np.arange(3 * nodes, dtype='<f8').reshape(nodes, 3)
    writer = CdrWriter()
    writer.put_sequence(triangles)
    writer.put_sequence(vertices)
    mesh = deserialize_message(writer.finish(), Mesh)
    assert [list(face.vertex_indices) for face in mesh.triangles] == triangles.tolist()
    assert [[node.x, node.y, node.z] for node in mesh.vertices] == vertices.tolist()


def test_encapsulation_is_that_of_ros():
    """Publishing the bytes would send another encoding than subscribers expect."""
    assert CdrWriter().finish() == serialize_message(Header())[:4]
