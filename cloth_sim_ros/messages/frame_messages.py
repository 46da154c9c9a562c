# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One frame: what is taken of a simulation, and the messages made of it."""

from collections.abc import Callable
from collections.abc import Iterator
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.camera.picture import CameraPicture
from cloth_sim_ros.camera.rig import CameraRig
from cloth_sim_ros.camera.rig import COLOR
from cloth_sim_ros.camera.rig import DEPTH
from cloth_sim_ros.camera.rig import INFO
from cloth_sim_ros.camera.rig import LABELS
from cloth_sim_ros.messages.body_frames import body_frames
from cloth_sim_ros.messages.body_frames import body_poses
from cloth_sim_ros.messages.body_frames import collider_wrenches
from cloth_sim_ros.messages.body_frames import grasp_peaks
from cloth_sim_ros.messages.body_frames import grasp_wrenches
from cloth_sim_ros.messages.camera_messages import camera_frames
from cloth_sim_ros.messages.camera_messages import CameraMessages
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import StatsMessage
from cloth_sim_ros.messages.markers import MarkersMessage
from cloth_sim_ros.messages.pins import MOST_PINS
from cloth_sim_ros.messages.pins import PinFrames
from cloth_sim_ros.messages.pins import WrenchMessages
from cloth_sim_ros.messages.stamp import serialise_clock
from cloth_sim_ros.messages.topics import camera_key
from cloth_sim_ros.sim.held.force_window import ForceWindow
from cloth_sim_ros.sim.held.force_window import FrameForces
from cloth_sim_ros.sim.held.grasps import Grasp
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np
from rclpy.serialization import serialize_message

# The topics of a frame, and the parameter that allows each.
PARAMETERS = {
    'clock': 'publish.clock', 'points': 'publish.points', 'markers': 'publish.markers',
    'stats': 'publish.stats', 'tf': 'publish.tf', 'pins/wrenches': 'publish.wrenches',
    'pins/peak_wrenches': 'publish.wrenches', 'grasps/wrenches': 'publish.wrenches',
    'grasps/peak_wrenches': 'publish.wrenches', 'colliders/wrenches': 'publish.wrenches'}
_CAMERAS = 'publish.cameras'
# What has to be taken of a picture for each part of its topics.
_TAKEN = {
    'image': COLOR, 'depth': DEPTH, 'points': DEPTH, 'labels': LABELS, 'camera_info': INFO}
_ALWAYS = frozenset(('clock', 'points', 'markers', 'stats'))
_OF_PINS = frozenset(('tf', 'pins/wrenches', 'pins/peak_wrenches'))
_OF_GRASPS = frozenset(('tf', 'grasps/wrenches', 'grasps/peak_wrenches'))
_OF_COLLIDERS = frozenset(('tf', 'colliders/wrenches'))
# Those that need the forces of the frame.
_WITH_FORCES = frozenset(key for key in PARAMETERS if key.endswith('wrenches'))


@dataclass(frozen=True)
class Pace:
    """
    How fast a frame was made.

    :param worked: wall time that its steps took [s]
    :param steps: of dt in it, 0 when the moment has been shown before
    :param achieved: simulated time per wall time
    :param wanted: the same as requested, 0 for as fast as possible
    :param too_slow: True when the last second fell short of that
    """

    worked: float = 0.0
    steps: int = 0
    achieved: float = 0.0
    wanted: float = 0.0
    too_slow: bool = False

    @property
    def step_wall_time(self) -> float:
        """Return the wall time of one dt [s]."""
        return self.worked / max(self.steps, 1)


@dataclass(frozen=True)
class FrameContent:
    """
    The content of one frame; later steps do not change it.

    :param keys: the topics that are wanted of it
    :param snapshot: None where nothing but the clock is wanted
    :param pinned: which nodes are held by pins alone, (rows, cols) bool
    :param forces: means over the frame; None where they are not wanted, or not known
    :param epoch: stamp of simulated time 0 [ns]
    :param pictures: of the cameras that have taken one
    """

    keys: frozenset[str]
    time: float
    pace: Pace
    snapshot: Snapshot | None
    pinned: np.ndarray
    forces: FrameForces | None
    pushes: tuple[Push, ...]
    grasps: tuple[Grasp, ...]
    colliders: tuple[Collider, ...]
    epoch: int = 0
    pictures: tuple[CameraPicture, ...] = ()


class FrameTaker:
    """
    Takes the frames of a simulation, on its thread.

    :param values: the node's parameter values, read at each frame
    :param place: returns where the tf frame of a camera is in the world; None where that is not
        known
    """

    def __init__(
            self, simulation: Simulation, values: Mapping[str, Any],
            place: Callable[[CameraModel], Pose | None] = lambda _: None) -> None:
        """Add up no forces yet, and take no pictures."""
        self._rig = CameraRig(simulation, place) if simulation.scene.cameras else None
        self._simulation = simulation
        self._values = values
        self._window: ForceWindow | None = None

    def take(
            self, is_read: Callable[[str], bool], pace: Callable[[], Pace],
            epoch: int = 0, *, ends_frame: bool = True) -> FrameContent:
        """
        Return what is read of the present moment.

        :param is_read: returns whether anybody reads the topic of a key
        :param pace: returns how fast the frame was made, asked when the device is done
        :param epoch: stamp of simulated time 0 [ns]
        :param ends_frame: False to look at a frame whose steps may still be under way; forces,
            which are means over all of them, are then left out
        """
        simulation = self._simulation
        pinned = simulation.pinned_nodes() & ~simulation.grasped_nodes()
        grasps, colliders = simulation.grasps, simulation.colliders
        has_pins = bool(0 < np.count_nonzero(pinned) <= MOST_PINS)
        there = set(_ALWAYS)
        for exists, keys in (
                (has_pins, _OF_PINS), (grasps, _OF_GRASPS), (colliders, _OF_COLLIDERS)):
            there |= keys if exists else frozenset()
        if simulation.scene.cameras:
            there.add('tf')
        wanted = frozenset(
            key for key in there if self._values[PARAMETERS[key]] and is_read(key))
        snapshot = simulation.snapshot() if wanted - {'clock'} else None
        forces = None
        if wanted & _WITH_FORCES:
            forces = self._forces(snapshot, ends_frame)
        elif ends_frame:
            self._leave_out_forces()
        # What pictures take is not the time of the steps.
        made = pace()
        picture_keys, pictures = self._pictures(is_read)
        return FrameContent(
            wanted | picture_keys, simulation.time, made, snapshot, pinned & has_pins, forces,
            tuple(applied.push for applied in simulation.pushes), grasps, colliders, epoch,
            tuple(pictures))

    def close(self) -> None:
        """Stop adding up forces, and release the cameras."""
        self._leave_out_forces()
        if self._rig is not None:
            self._rig.close()

    def _pictures(
            self, is_read: Callable[[str], bool]) -> tuple[frozenset[str], list[CameraPicture]]:
        """Return the keys that are read of the cameras that are due, and their pictures."""
        keys: set[str] = set()
        pictures: list[CameraPicture] = []
        if self._rig is None or not self._values[_CAMERAS]:
            return frozenset(), []
        for model in self._simulation.scene.cameras:
            parts = {part for part in _TAKEN if is_read(camera_key(model.name, part))}
            if not parts or not self._rig.is_due(model):
                continue
            picture = self._rig.take(model, {_TAKEN[part] for part in parts})
            if picture is not None:
                pictures.append(picture)
                keys |= {camera_key(model.name, part) for part in parts}
        return frozenset(keys), pictures

    def _forces(self, snapshot: Snapshot | None, ends_frame: bool) -> FrameForces | None:
        """
        Return the means over the frame; None where they can't be known yet.

        The first frame in which they are wanted has those of the last step of dt, if these are
        known.
        """
        if self._window is None:
            self._window = self._simulation.open_force_window()
        if not self._simulation.knows_forces or not ends_frame and self._window.steps:
            return None
        return self._simulation.frame_forces(self._window, snapshot)

    def _leave_out_forces(self) -> None:
        if self._window is not None:
            self._simulation.close_force_window(self._window)
            self._window = None


class FrameMessages:
    """
    Makes the messages of frames, in the bytes that go out.

    :param node_name: with its namespace
    :param frame_id: of the positions
    """

    def __init__(self, scene: Scene, node_name: str, frame_id: str) -> None:
        """Serialise what stays the same from frame to frame."""
        self._node_name = node_name
        self._frame_id = frame_id
        self._points = PointsMessage(
            scene.rows, scene.cols, frame_id, is_dense=not scene.has_gaps)
        self._markers = MarkersMessage(
            scene.rows, scene.cols, frame_id, present=scene.cut_cells)
        self._stats = StatsMessage(frame_id)
        self._pin_frames = PinFrames(node_name, frame_id)
        self._wrenches = WrenchMessages(node_name)
        self._cameras = scene.cameras
        self._camera_messages: dict[str, CameraMessages] = {}

    def of(self, frame: FrameContent) -> Iterator[tuple[str, bytes]]:
        """Yield the key of a topic and each message, frames before what is given in them."""
        keys = frame.keys
        if 'clock' in keys:
            yield 'clock', serialise_clock(frame.time, frame.epoch)
        if 'tf' in keys:
            for message in camera_frames(
                    self._cameras, self._node_name, frame.time, self._frame_id, frame.epoch):
                yield 'tf', serialize_message(message)
        yield from self._of_cameras(frame)
        snapshot = frame.snapshot
        if snapshot is None:
            return
        if 'points' in keys:
            yield 'points', self._points.serialise(snapshot, frame.epoch)
        if 'markers' in keys:
            yield 'markers', self._markers.serialise(
                snapshot, frame.pushes, frame.colliders, frame.grasps, frame.epoch)
        if 'stats' in keys:
            pace = frame.pace
            yield 'stats', self._stats.serialise(
                snapshot, step_wall_time=pace.step_wall_time, real_time_factor=pace.achieved,
                wanted_factor=pace.wanted, too_slow=pace.too_slow, epoch=frame.epoch)
        if 'tf' in keys and frame.pinned.any():
            yield 'tf', self._pin_frames.serialise(
                snapshot, ~frame.pinned, frame.epoch)
        yield from self._pin_wrenches(frame)
        yield from self._of_bodies(frame)

    def _of_cameras(self, frame: FrameContent) -> Iterator[tuple[str, bytes]]:
        for picture in frame.pictures:
            camera = picture.camera
            if camera.name not in self._camera_messages:
                self._camera_messages[camera.name] = CameraMessages(camera, self._node_name)
            yield from self._camera_messages[camera.name].of(picture, frame.keys, frame.epoch)

    def _pin_wrenches(self, frame: FrameContent) -> Iterator[tuple[str, bytes]]:
        if frame.forces is None:
            return
        pins = frame.forces.pins
        for key, values in (
                ('pins/wrenches', pins.forces), ('pins/peak_wrenches', pins.peaks)):
            if key in frame.keys:
                for data in self._wrenches.serialise(
                        pins.nodes, values, frame.time, frame.epoch):
                    yield key, data

    def _of_bodies(self, frame: FrameContent) -> Iterator[tuple[str, bytes]]:
        name, now, epoch = self._node_name, frame.time, frame.epoch
        if 'tf' in frame.keys and (frame.grasps or frame.colliders):
            poses = body_poses(name, frame.grasps, frame.colliders)
            yield 'tf', serialize_message(body_frames(poses, now, self._frame_id, epoch))
        forces = frame.forces
        if forces is None:
            return
        wrenches = {
            'grasps/wrenches': grasp_wrenches(name, frame.grasps, forces.grasps, now, epoch),
            'grasps/peak_wrenches': grasp_peaks(name, frame.grasps, forces.grasps, now, epoch),
            'colliders/wrenches': collider_wrenches(
                name, frame.colliders, forces.contacts, now, epoch)}
        for key, messages in wrenches.items():
            if key in frame.keys:
                for message in messages:
                    yield key, serialize_message(message)
