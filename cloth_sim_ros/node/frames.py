# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a frame is made of: the cloud, markers, plain numbers, pins and bodies of one moment."""

from collections.abc import Callable
from collections.abc import Mapping
import time
from typing import Any

from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.node.body_topics import body_messages
from cloth_sim_ros.node.body_topics import GRASPS
from cloth_sim_ros.node.body_topics import wanted_of_bodies
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.own_frames import OwnFrames
from cloth_sim_ros.node.pin_topics import PinTopics
from cloth_sim_ros.node.pin_topics import WRENCHES
from cloth_sim_ros.sim.simulation import Simulation
from rclpy.serialization import serialize_message
from rosgraph_msgs.msg import Clock

_PARTS = ('points', 'markers', 'stats')


class Frames:
    """
    Send the topics that show the cloth.

    :param values: the node's parameter values, read at each frame
    :param node_name: with its namespace
    :param own: is told where pins, grasps and colliders are in each frame
    :param warn: called with what a user should know
    """

    def __init__(
            self, simulation: Simulation, outlet: Outlet, values: Mapping[str, Any],
            node_name: str, own: OwnFrames, warn: Callable[[str], None]) -> None:
        """Prepare the messages of this cloth."""
        scene = simulation.scene
        self._simulation = simulation
        self._outlet = outlet
        self._values = values
        self._frame_id = values['frame_id']
        self._points = PointsMessage(scene.rows, scene.cols, self._frame_id)
        self._markers = MarkersMessage(scene.rows, scene.cols, self._frame_id)
        self._pins = PinTopics(simulation, outlet, values, node_name, warn)
        self._own = own
        self._node_name = node_name

    def send(
            self, *, worked: float = 0.0, steps: int = 0, real_time_factor: float = 0.0,
            too_slow: bool = False, to_recording: bool = True) -> None:
        """
        Send what is wanted of the moment.

        :param worked: wall time the steps of this frame took [s]
        :param steps: of dt in this frame, 0 when the moment has been there before
        :param real_time_factor: simulated time per wall time, achieved
        :param too_slow: True when that falls short of what is asked for
        :param to_recording: False to show the same moment once more
        """
        simulation = self._simulation
        now = simulation.time
        self._outlet.send_message(
            'clock', Clock(clock=stamp(now)), now, to_recording=to_recording)
        made = [
            part for part in _PARTS if self._values[f'publish.{part}']
            and self._outlet.wanted(part, by_recording=to_recording)]
        of_pins = self._pins.wanted(by_recording=to_recording)
        of_bodies = wanted_of_bodies(
            simulation, self._values, self._outlet, by_recording=to_recording)
        if not (made or of_pins or of_bodies):
            return
        begin = time.monotonic()
        snapshot = simulation.snapshot(pin_forces=WRENCHES in of_pins or GRASPS in of_bodies)
        # The device may still be at work when the steps return: the read-back waits for it.
        worked += time.monotonic() - begin
        makers = {
            'points': lambda: self._points.serialise(snapshot),
            'markers': lambda: self._markers.serialise(
                snapshot, [applied.push for applied in simulation.pushes],
                simulation.colliders, simulation.grasps),
            'stats': lambda: serialize_message(stats_message(
                snapshot, self._frame_id, step_wall_time=worked / max(steps, 1),
                real_time_factor=real_time_factor,
                wanted_factor=self._values['real_time_factor'], too_slow=too_slow)),
        }
        for part in made:
            self._outlet.send(part, makers[part], now, to_recording=to_recording)
        if of_pins:
            self._own.note_pins(snapshot)
        if of_bodies:
            self._own.note_bodies()
        self._pins.send(snapshot, of_pins, to_recording=to_recording)
        for key, message in body_messages(
                simulation, snapshot, of_bodies, self._node_name, self._frame_id):
            self._outlet.send_message(key, message, now, to_recording=to_recording)
