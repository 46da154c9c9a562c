# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A marker put by hand, read by ROS."""

from builtin_interfaces.msg import Time
from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.messages.marker import put_marker
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose
from geometry_msgs.msg import Vector3
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from std_msgs.msg import ColorRGBA
from std_msgs.msg import Header
from visualization_msgs.msg import Marker
from visualization_msgs.msg import MarkerArray


@pytest.mark.parametrize('frame_id', ['', 'a', 'ab', 'abc', 'abcd', 'world'])
@pytest.mark.parametrize('count', [0, 1, 3])
def test_every_field_is_read_back(frame_id, count):
    """Markers of some frame names or sizes would be read from the wrong place."""
    points = np.arange(3.0 * count).reshape(count, 3)
    colors = np.linspace(0.0, 1.0, 4 * count, dtype=np.float32).reshape(count, 4)
    writer = CdrWriter()
    writer.put('I', 2)
    for number in (5, 6):
        put_marker(
            writer, time=Time(sec=7, nanosec=8), frame_id=frame_id, namespace='pins',
            number=number, kind=Marker.POINTS, scale=(0.5, 0.25, 0.125),
            color=(0.0, 0.25, 0.5, 1.0), points=points, colors=colors)
    expected = [
        Marker(
            header=Header(stamp=Time(sec=7, nanosec=8), frame_id=frame_id), ns='pins', id=number,
            type=Marker.POINTS, action=Marker.ADD, pose=Pose(),
            scale=Vector3(x=0.5, y=0.25, z=0.125), color=ColorRGBA(g=0.25, b=0.5, a=1.0),
            points=[Point(x=x, y=y, z=z) for x, y, z in points.tolist()],
            colors=[ColorRGBA(r=r, g=g, b=b, a=a) for r, g, b, a in colors.tolist()])
        for number in (5, 6)]
    assert deserialize_message(writer.finish(), MarkerArray).markers == expected
