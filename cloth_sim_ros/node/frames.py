# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a frame is made of: the cloud, markers, plain numbers, pins and bodies of one moment."""

from collections.abc import Callable
from collections.abc import Collection
from collections.abc import Mapping
from collections.abc import Sequence
from functools import partial
import time
from typing import Any
from typing import Protocol

from cloth_sim_ros.messages.body_frames import body_frames
from cloth_sim_ros.messages.body_frames import body_poses
from cloth_sim_ros.messages.body_frames import collider_wrenches
from cloth_sim_ros.messages.body_frames import grasp_peaks
from cloth_sim_ros.messages.body_frames import grasp_wrenches
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import StatsMessage
from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.messages.pins import PinFrames
from cloth_sim_ros.messages.pins import too_many_pins
from cloth_sim_ros.messages.pins import WrenchMessages
from cloth_sim_ros.messages.stamp import serialise_clock
from cloth_sim_ros.messages.wanted_forces import WantedForces
from cloth_sim_ros.node.input_frames import OwnFrames
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.sim.force_window import FrameForces
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

PIN_FRAMES, WRENCHES, PEAKS = 'tf', 'pins/wrenches', 'pins/peak_wrenches'
_PIN_PARAMETERS = {
    PIN_FRAMES: 'publish.tf', WRENCHES: 'publish.wrenches', PEAKS: 'publish.wrenches'}


class PinTopics:
    """
    Send /tf, one message a frame, ~/pins/wrenches and ~/pins/peak_wrenches, one message a pin.

    :param values: the node's parameter values, read at each frame
    :param node_name: with its namespace
    :param warn: called with the reason when pins become too many
    """

    def __init__(
            self, simulation: Simulation, outlet: Outlet, values: Mapping[str, Any],
            node_name: str, warn: Callable[[str], None]) -> None:
        """Keep the parts."""
        self._simulation = simulation
        self._outlet = outlet
        self._values = values
        self._warn = warn
        self._frames = PinFrames(node_name, values['frame_id'])
        self._wrenches = WrenchMessages(node_name)
        self._reason = ''

    def wanted(self, *, by_recording: bool = True) -> frozenset[str]:
        """Return which topics are sent; WRENCHES and PEAKS need the forces of the frame."""
        wanted = frozenset(
            key for key, parameter in _PIN_PARAMETERS.items()
            if self._values[parameter] and self._outlet.wanted(key, by_recording=by_recording))
        if not wanted:
            return wanted
        pins = int(np.count_nonzero(
            self._simulation.pinned_nodes() & ~self._simulation.grasped_nodes()))
        reason = too_many_pins(pins)
        if reason and not self._reason:
            self._warn(reason)
        self._reason = reason
        return wanted if pins > 0 and not reason else frozenset()

    def send(
            self, snapshot: Snapshot, held: np.ndarray, forces: FrameForces | None,
            wanted: Collection[str], *, to_recording: bool = True) -> None:
        """
        Send what is ``wanted`` of ``snapshot``, the frames before what is given in them.

        :param held: which nodes grasps hold, (rows, cols) bool
        :param forces: of the frame, where WRENCHES or PEAKS are wanted
        """
        if PIN_FRAMES in wanted:
            self._outlet.send(
                PIN_FRAMES, lambda: self._frames.serialise(snapshot, held), snapshot.time,
                to_recording=to_recording)
        for key, messages in pin_messages(self._wrenches, forces, snapshot.time, wanted):
            for data in messages:
                self._outlet.send(
                    key, partial(bytes, data), snapshot.time, to_recording=to_recording)


def pin_messages(
        wrenches: WrenchMessages, forces: FrameForces | None, now: float,
        wanted: Collection[str]) -> Sequence[tuple[str, list[bytes]]]:
    """Return what is ``wanted`` of WRENCHES and PEAKS, and the messages ``now`` [s] of each."""
    if forces is None:
        return []
    pins = forces.pins
    return [
        (key, wrenches.serialise(pins.nodes, values, now))
        for key, values in ((WRENCHES, pins.forces), (PEAKS, pins.peaks)) if key in wanted]


# What is sent of grasps and colliders: their frames, and what the cloth does to them.

FRAMES, COLLIDERS = 'tf', 'colliders/wrenches'
GRASPS, GRASP_PEAKS = 'grasps/wrenches', 'grasps/peak_wrenches'
_BODY_PARAMETERS = {
    FRAMES: 'publish.tf', GRASPS: 'publish.wrenches', GRASP_PEAKS: 'publish.wrenches',
    COLLIDERS: 'publish.wrenches'}
# What needs the forces of the frame.
WITH_FORCES = frozenset((WRENCHES, PEAKS, GRASPS, GRASP_PEAKS, COLLIDERS))


class Readers(Protocol):
    """What knows whether a topic is read."""

    def wanted(self, key: str, *, by_recording: bool = True) -> bool:
        """Tell whether anybody reads the topic ``key`` now."""


def wanted_of_bodies(
        simulation: Simulation, values: Mapping[str, Any], readers: Readers, *,
        by_recording: bool = True) -> frozenset[str]:
    """Return which topics of grasps and colliders are to be sent."""
    there = set()
    if simulation.grasps:
        there |= {FRAMES, GRASPS, GRASP_PEAKS}
    if simulation.colliders:
        there |= {FRAMES, COLLIDERS}
    return frozenset(
        key for key in there if values[_BODY_PARAMETERS[key]]
        and readers.wanted(key, by_recording=by_recording))


def body_messages(
        simulation: Simulation, snapshot: Snapshot, forces: FrameForces | None,
        wanted: frozenset[str], node_name: str, frame_id: str) -> Sequence[tuple[str, Any]]:
    """
    Return topics and messages of what is ``wanted``, the frames before what is in them.

    :param forces: of the frame, where some of WITH_FORCES are wanted
    """
    now, grasps, colliders = snapshot.time, simulation.grasps, simulation.colliders
    messages: list[tuple[str, Any]] = []
    if FRAMES in wanted:
        poses = body_poses(node_name, grasps, colliders)
        messages.append((FRAMES, body_frames(poses, now, frame_id)))
    if forces is None:
        return messages
    made = (
        (GRASPS, lambda: grasp_wrenches(node_name, grasps, forces.grasps, now)),
        (GRASP_PEAKS, lambda: grasp_peaks(node_name, grasps, forces.grasps, now)),
        (COLLIDERS, lambda: collider_wrenches(node_name, colliders, forces.contacts, now)))
    for key, make in made:
        if key in wanted:
            messages += [(key, wrench) for wrench in make()]
    return messages


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
        self._stats = StatsMessage(self._frame_id)
        self._pins = PinTopics(simulation, outlet, values, node_name, warn)
        self._forces = WantedForces(simulation)
        self._own = own
        self._node_name = node_name

    def send(
            self, *, worked: float = 0.0, steps: int = 0, real_time_factor: float = 0.0,
            too_slow: bool = False, to_recording: bool = True,
            later: bool = False) -> Callable[[], None] | None:
        """
        Send what is wanted of the moment.

        :param worked: wall time the steps of this frame took [s]
        :param steps: of dt in this frame, 0 when the moment has been there before
        :param real_time_factor: simulated time per wall time, achieved
        :param too_slow: True when that falls short of what is asked for
        :param to_recording: False to show the same moment once more
        :param later: True only has the device make the snapshot, and returns what waits for it
            and sends; a frame with forces, or with grasps or colliders, is sent at once
        """
        simulation = self._simulation
        now, held = simulation.time, simulation.grasped_nodes()
        made = [
            part for part in _PARTS if self._values[f'publish.{part}']
            and self._outlet.wanted(part, by_recording=to_recording)]
        of_pins = self._pins.wanted(by_recording=to_recording)
        of_bodies = wanted_of_bodies(
            simulation, self._values, self._outlet, by_recording=to_recording)
        drawn = (
            [applied.push for applied in simulation.pushes], simulation.colliders,
            simulation.grasps) if 'markers' in made else ()
        has_forces = bool(WITH_FORCES & (of_pins | of_bodies))
        is_pending = later and bool(made or of_pins) and not (has_forces or of_bodies)
        begin = time.monotonic()
        take = (
            simulation.begin_snapshot() if is_pending
            else simulation.snapshot)
        if not has_forces:
            self._forces.leave_out()
        began = time.monotonic() - begin

        def send() -> None:
            # Whoever plays a recording of it would move the time of every node.
            self._outlet.send(
                'clock', lambda: serialise_clock(now), now,
                to_recording=to_recording and self._values['publish.clock'])
            if not (made or of_pins or of_bodies):
                return
            begin = time.monotonic()
            snapshot = take()
            # The device may still be at work when the steps return: the read-back waits for it.
            spent = worked + began + time.monotonic() - begin
            makers = {
                'points': lambda: self._points.serialise(snapshot),
                'markers': lambda: self._markers.serialise(snapshot, *drawn),
                'stats': lambda: self._stats.serialise(
                    snapshot, step_wall_time=spent / max(steps, 1),
                    real_time_factor=real_time_factor,
                    wanted_factor=self._values['real_time_factor'], too_slow=too_slow),
            }
            for part in made:
                self._outlet.send(part, makers[part], now, to_recording=to_recording)
            if of_pins:
                self._own.note_pins(snapshot)
            if of_bodies:
                self._own.note_bodies()
            forces = self._forces.of(snapshot) if has_forces else None
            self._pins.send(snapshot, held, forces, of_pins, to_recording=to_recording)
            for key, message in body_messages(
                    simulation, snapshot, forces, of_bodies, self._node_name, self._frame_id):
                self._outlet.send_message(key, message, now, to_recording=to_recording)

        if is_pending:
            return send
        send()
        return None
