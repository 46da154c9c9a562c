# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Every topic that goes out: what the node publishes is what the recorder writes."""

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import ModeChange
from cloth_sim_interfaces.msg import PinChange
from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_ros.messages.topic import Topic
from cloth_sim_ros.messages.wrenches import MOST_PINS
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Vector3Stamped
from geometry_msgs.msg import WrenchStamped
from rcl_interfaces.msg import ParameterEvent
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from shape_msgs.msg import Mesh
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

# Markers are drawn from the points, at many times their size: a recording keeps the points.
TOPICS = {
    topic.key: topic for topic in (
        Topic('points', PointCloud2, depth=10, text='one point per node, organised as rows and '
              'columns: position, velocity, normal, strain, flags'),
        Topic('markers', MarkerArray, depth=1, recorded=False, text='the surface coloured by '
              'strain, pins, nodes at their strain limit, and pushes'),
        Topic('topology', Mesh, depth=1, transient_local=True, text='the cloth at rest as a '
              'triangle mesh'),
        Topic('stats', ClothStats, depth=10, text='energies, largest strain, solver, constraints '
              'and real-time factor as plain numbers to plot'),
        # A message a pin: a whole frame of them must have room.
        Topic('pins/wrenches', WrenchStamped, depth=MOST_PINS, text='force that the cloth '
              'exerts on each pin, one message per pin'),
        Topic('state', ClothState, depth=1, transient_local=True, text='mode, run state, device '
              'and recording'),
        # As tf2's own broadcasters have it.
        Topic('tf', TFMessage, depth=100, is_global=True, text='a frame for each pin, such as '
              '`cloth_sim_pin_0_31`'),
        Topic('clock', Clock, depth=10, is_global=True, text='simulated time, when '
              '`publish.clock` is true'),
        Topic('diagnostics', DiagnosticArray, depth=10, is_global=True, text='health of the '
              'device, real-time factor, solver, stability and recorder, once per second of wall '
              'time'),
        Topic('inputs/push', Push, depth=100, text='each accepted push'),
        Topic('inputs/pin', PinChange, depth=100, text='each node that was pinned or released'),
        Topic('inputs/pin_target', PinTarget, depth=100, text='each accepted target of a pin'),
        Topic('inputs/wind', Vector3Stamped, depth=100, text='each change of the steady wind'),
        Topic('inputs/mode', ModeChange, depth=100, text='each mode switch'),
        Topic('inputs/command', Command, depth=100, text='each reset, and each cancellation of '
              'all pushes'),
        Topic('inputs/parameters', ParameterEvent, depth=100, text='each parameter change'),
    )}
