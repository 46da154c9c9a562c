# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One marker of a MarkerArray, put into CDR without a Python object per point."""

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.cdr_writer import CdrWriter
import numpy as np
from visualization_msgs.msg import Marker

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
_NO_POINTS = np.empty((0, 3))
_NO_COLORS = np.empty((0, 4), '<f4')


def put_marker(
        writer: CdrWriter, *, time: Time, frame_id: str, namespace: str, number: int,
        action: int = Marker.ADD, kind: int = 0,
        scale: tuple[float, float, float] = (0.0, 0.0, 0.0),
        color: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0),
        points: np.ndarray = _NO_POINTS, colors: np.ndarray = _NO_COLORS) -> None:
    """
    Put a visualization_msgs/Marker.

    :param kind: Marker.TRIANGLE_LIST and so on
    :param points: (n, 3) float64
    :param colors: (n, 4) float32, or empty for ``color`` everywhere
    """
    _put_header(writer, time, frame_id)
    writer.put_string(namespace)
    writer.put('i', number, kind, action)
    writer.put('d', 0.0, 0.0, 0.0, *_NO_TURN, *scale)
    writer.put('f', *color)
    writer.put('i', 0)  # lifetime: for ever
    writer.put('I', 0)
    writer.put('?', False)  # frame_locked
    writer.put_sequence(points)
    writer.put_sequence(colors)
    writer.put_string('')  # texture_resource
    _put_header(writer, Time(), '')  # texture
    writer.put_string('')
    writer.put('I', 0)
    writer.put('I', 0)  # uv_coordinates
    writer.put_string('')  # text
    writer.put_string('')  # mesh_resource
    writer.put_string('')  # mesh_file
    writer.put('I', 0)
    writer.put('?', False)  # mesh_use_embedded_materials


def _put_header(writer: CdrWriter, time: Time, frame_id: str) -> None:
    writer.put('i', time.sec)
    writer.put('I', time.nanosec)
    writer.put_string(frame_id)
