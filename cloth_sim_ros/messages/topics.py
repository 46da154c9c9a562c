# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Every published topic: the node and the recorder use the same table."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from cloth_sim_interfaces.msg import ClothState
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import FrameTarget
from cloth_sim_interfaces.msg import GraspChange
from cloth_sim_interfaces.msg import ModeChange
from cloth_sim_interfaces.msg import PinChange
from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.msg import TimeBase
from cloth_sim_ros.messages.pins import MOST_PINS
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Vector3Stamped
from geometry_msgs.msg import WrenchStamped
from rcl_interfaces.msg import ParameterEvent
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo
from sensor_msgs.msg import Image
from sensor_msgs.msg import PointCloud2
from shape_msgs.msg import Mesh
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray


@dataclass(frozen=True)
class Topic:
    """
    A topic the simulator publishes or records.

    :param key: its name behind the node's, or behind / when ``is_global``
    :param message: class of its messages
    :param depth: messages kept for slow subscribers
    :param reliable: False for best effort
    :param transient_local: True to keep the last ``depth`` for late subscribers
    :param is_global: True for a name that does not depend on the node
    :param recorded: False for what a recording leaves out, unless it is requested
    :param text: one line for people
    """

    key: str
    message: type
    depth: int
    reliable: bool = True
    transient_local: bool = False
    is_global: bool = False
    recorded: bool = True
    text: str = ''

    @property
    def name(self) -> str:
        """Name to publish under: private to the node, or global."""
        return f'/{self.key}' if self.is_global else f'~/{self.key}'

    @property
    def type_name(self) -> str:
        """Name of the message type, such as std_msgs/msg/Header."""
        return f'{self.message.__module__.split(".")[0]}/msg/{self.message.__name__}'

    def full_name(self, node_name: str) -> str:
        """Return the name in the graph, for the node ``node_name``, namespace included."""
        return self.name.replace('~', f'/{node_name.lstrip("/")}')


# Markers are drawn from the points, at several times their size: a recording keeps the points,
# and the markers only where recording.markers asks for them.
TOPICS = {
    topic.key: topic for topic in (
        Topic('points', PointCloud2, depth=10, text='one point per node, organised as rows and '
              'columns: position, velocity, normal, strain, flags'),
        Topic('markers', MarkerArray, depth=1, recorded=False, text='the surface coloured by '
              'strain, pins, nodes at their strain limit, pushes, grasps, and the colliders'),
        Topic('topology', Mesh, depth=1, transient_local=True, text='the cloth at rest as a '
              'triangle mesh'),
        Topic('stats', ClothStats, depth=10, text='energies, largest strain, solver, constraints '
              'and real-time factor as plain numbers to plot'),
        # A message a pin: a whole frame of them must have room.
        Topic('pins/wrenches', WrenchStamped, depth=MOST_PINS, text='force of the cloth on each '
              'pin, mean over the frame, one message per pin'),
        Topic('pins/peak_wrenches', WrenchStamped, depth=MOST_PINS, text='force of the cloth on '
              'each pin in the substep of the frame in which it was strongest'),
        Topic('grasps/wrenches', WrenchStamped, depth=100, text='force and torque of the cloth on '
              'each grasp, means over the frame, one message per grasp'),
        Topic('grasps/peak_wrenches', WrenchStamped, depth=100, text='force of the cloth on each '
              'grasp in the substep of the frame in which it was strongest, without torque'),
        Topic('colliders/wrenches', WrenchStamped, depth=100, text='force and torque of the cloth '
              'on each collider, means over the frame, one message per collider'),
        Topic('state', ClothState, depth=1, transient_local=True, text='mode, run state, device '
              'and recording'),
        # As tf2's own broadcasters have it.
        Topic('tf', TFMessage, depth=100, is_global=True, text='a frame for each pin, grasp '
              'and collider, such as `cloth_sim_pin_0_31`'),
        Topic('clock', Clock, depth=10, is_global=True, text='simulated time, when '
              '`publish.clock` is true'),
        Topic('diagnostics', DiagnosticArray, depth=10, is_global=True, text='health of the '
              'device, real-time factor, solver, stability and recorder, once per second of wall '
              'time'),
        Topic('inputs/push', Push, depth=100, text='each accepted push'),
        Topic('inputs/pin', PinChange, depth=100, text='each node that was pinned or released'),
        Topic('inputs/pin_target', PinTarget, depth=100, text='each accepted target of a pin'),
        Topic('inputs/grasp', GraspChange, depth=100, text='each grasp, and each release or loss '
              'of one'),
        Topic('inputs/grasp_target', FrameTarget, depth=100, text='each accepted target of a '
              'grasp'),
        Topic('inputs/collider_target', FrameTarget, depth=100, text='each accepted target of a '
              'collider'),
        Topic('inputs/wind', Vector3Stamped, depth=100, text='each change of the steady wind'),
        Topic('inputs/mode', ModeChange, depth=100, text='each mode switch'),
        Topic('inputs/command', Command, depth=100, text='each reset, and each cancellation of '
              'all pushes'),
        Topic('inputs/parameters', ParameterEvent, depth=100, text='each parameter change'),
        Topic('inputs/time_base', TimeBase, depth=1, transient_local=True, text='each change of '
              'the stamp of simulated time 0'),
    )}

# Those of each camera; NAME stands for its name. A recording has them where recording.cameras asks
# for them, and never the points, which follow from depth and camera_info.
CAMERA_PARTS = {
    'image': (Image, 'colours, rgb8'),
    'depth': (Image, 'depth along the optical axis [m], 32FC1: +inf where nothing is nearer than '
              'far, -inf where something is nearer than near (REP 118)'),
    'camera_info': (CameraInfo, 'the pinhole of the camera, without distortion'),
    'labels': (Image, 'what each pixel sees, mono8: 0 nothing, 1 the cloth, 2 the first of '
               '`colliders.names`, 3 the next'),
    'points': (PointCloud2, 'depth as an organised cloud in the optical frame; NaN where it is '
               'not finite'),
}

RECORDED_PARTS = tuple(part for part in CAMERA_PARTS if part != 'points')


def camera_key(name: str, part: str) -> str:
    """Return the key of the topic with a part of the pictures of a camera."""
    return f'cameras/{name}/{part}'


def camera_topics(
        names: Iterable[str], parts: Iterable[str] = tuple(CAMERA_PARTS)) -> dict[str, Topic]:
    """Return the topics of ``parts`` of the cameras ``names`` by their keys."""
    return {
        camera_key(name, part): Topic(
            camera_key(name, part), CAMERA_PARTS[part][0], depth=10, recorded=False,
            text=CAMERA_PARTS[part][1])
        for name in names for part in parts}


@cache
def topic_of(key: str) -> Topic:
    """Return the topic of a ``key``, one of TOPICS or of a camera; KeyError for another."""
    name = key.removeprefix('cameras/').partition('/')[0]
    return TOPICS[key] if key in TOPICS else camera_topics([name])[key]
