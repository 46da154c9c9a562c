# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of a recording in the order of time, with the colliders where they are then."""

from collections.abc import Iterable
from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.analysis import input_history
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.input_history import PushHistory
from cloth_sim_ros.analysis.recorded_values import plain_value
from cloth_sim_ros.analysis.recorded_values import recorded_pose
from cloth_sim_ros.analysis.recorded_values import RESET
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.colliders import NAMES
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePaths
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np

_PARAMETERS, _TARGETS, _COMMANDS = (
    'inputs/parameters', 'inputs/collider_target', 'inputs/command')
COLLIDER_KEYS = (_PARAMETERS, _TARGETS, _COMMANDS)
# Parameter groups of the colliders and of their scheduled motion.
_GROUPS = ('colliders', 'collider_moves', 'motion')


class ColliderHistory:
    """
    The colliders of a recorded run, from the messages of the topics COLLIDER_KEYS in order.

    The scene's moves and the recorded targets are what the run itself has followed, so that no
    frame of /tf is needed. ``problem`` says why there are none though the scene has some; it is
    empty otherwise.
    """

    def __init__(self) -> None:
        """Begin without colliders."""
        self.problem = ''
        self._scene: Scene | None = None
        self._paths = FramePaths({})

    def read(self, entry: Entry) -> None:
        """Apply one message."""
        if entry.key == _PARAMETERS and entry.message.new_parameters:
            self._begin(entry.message.new_parameters)
        elif entry.key == _TARGETS:
            self._move(entry.message)
        elif entry.key == _COMMANDS and entry.message.command == RESET:
            self._begin_run()

    def at(self, stamp: Any) -> tuple[Collider, ...]:
        """Return the colliders where they are at the ROS time ``stamp`` of the run."""
        if self._scene is None:
            return ()
        poses = [
            (collider, self._paths.pose(collider.name, _seconds(stamp)))
            for collider in self._scene.colliders]
        return tuple(
            replace(collider, position=pose.position, orientation=pose.orientation)
            for collider, pose in poses)

    def _begin(self, parameters: Any) -> None:
        given = {
            parameter.name: plain_value(parameter.value) for parameter in parameters
            if parameter.name.partition('.')[0] in _GROUPS}
        self._scene, self.problem = None, ''
        if not given.get(NAMES):
            return
        known = {field.name for field in all_fields(given)}
        try:
            self._scene = Scene({
                name: value for name, value in given.items() if name in known})
        except ClothSimError as error:
            self.problem = str(error)
        self._begin_run()

    def _begin_run(self) -> None:
        if self._scene is not None:
            self._paths = FramePaths(
                {collider.name: collider.pose for collider in self._scene.colliders},
                self._scene.timed_collider_moves())

    def _move(self, message: Any) -> None:
        if self._scene is None:
            return
        if message.name not in [collider.name for collider in self._scene.colliders]:
            return
        start = _seconds(message.header.stamp)
        try:
            pose = recorded_pose(message.pose)
            orientation = None if message.keep_orientation else pose.orientation
            if message.speed == 0.0:
                # Where it is as the recording begins.
                move = FrameMove(
                    message.name, pose.position, orientation, math.inf, math.inf, start)
            else:
                move = FrameMove.checked(
                    name=message.name, target=pose.position, orientation=orientation,
                    speed=message.speed, angular_speed=message.angular_speed, start=start)
        except ClothSimError as error:
            self.problem = str(error)
            return
        self._paths.add(move)


def _seconds(stamp: Any) -> float:
    return stamp.sec + 1e-9 * stamp.nanosec


# The frames of a recording, in the order of time.

# How far a time that is read off and typed may be beside that of a frame [s].
_ROUNDING = 1e-6


def read_frames(recording: Recording) -> Iterator[Frame]:
    """Yield every frame, with pushes given before it and colliders; one is in memory at a time."""
    pushes, colliders = PushHistory(), ColliderHistory()
    for entry in recording.entries('points', *input_history.PUSH_KEYS, *COLLIDER_KEYS):
        if entry.key == 'points':
            yield Frame.from_points(
                entry.time, entry.message, pushes.pushes, colliders.at(entry.message.header.stamp))
            continue
        if entry.key in input_history.PUSH_KEYS:
            pushes.read(entry)
        if entry.key in COLLIDER_KEYS:
            colliders.read(entry)


def frames_at(recording: Recording, times: Sequence[float]) -> list[Frame]:
    """
    Return the frame nearest to each of ``times`` [s], which grow.

    :raises ClothSimError: when the recording holds no frame
    """
    wanted = list(times)
    chosen: list[Frame] = []
    before = None
    for frame in read_frames(recording):
        while wanted and frame.time >= wanted[0]:
            if before is not None and wanted[0] - before.time < frame.time - wanted[0]:
                chosen.append(before)
            else:
                chosen.append(frame)
            wanted.pop(0)
        before = frame
        if not wanted:
            break
    if before is None:
        raise recording.no_frame()
    return chosen + [before] * len(wanted)


def frame_at(recording: Recording, time: float | None = None) -> Frame:
    """
    Return the frame nearest to ``time`` [s], or the last one.

    :raises ClothSimError: when the recording holds no frame, or none of before and after ``time``
    """
    begin = 0.0
    before = None
    for frame in read_frames(recording):
        begin = frame.time if before is None else begin
        if time is not None and begin - _ROUNDING <= time <= frame.time:
            is_before = before is not None and time - before.time < frame.time - time
            return before if before is not None and is_before else frame
        before = frame
    if before is None:
        raise recording.no_frame()
    if time is None or begin <= time <= before.time + _ROUNDING:
        return before
    raise ClothSimError(
        f'{cut(recording.path)} has frames from {begin:.9g} to {before.time:.9g} s, and none at '
        f'{time:.9g} s: give a time between them')


def default_times(recording: Recording, count: int) -> list[float]:
    """Return ``count`` times [s] that show what happens; ClothSimError without a frame."""
    times: list[float] = []
    pushes: dict[tuple[float, tuple[float, float, float]], Push] = {}
    for frame in read_frames(recording):
        times.append(frame.time)
        # As it was last seen: an early end shortens it.
        pushes.update({(push.start, push.force): push for push in frame.pushes})
    if not times:
        raise recording.no_frame()
    return panel_times(times[0], times[-1], pushes.values(), count)


def panel_times(begin: float, end: float, pushes: Iterable[Push], count: int) -> list[float]:
    """
    Return ``count`` times from ``begin`` to ``end`` [s], evenly apart but for the pushes.

    The time next to the middle of a push moves there, so that the push is seen; the first and
    the last stay, and a time moves once.
    """
    times = np.linspace(begin, end, count)
    free = set(range(1, count - 1))
    for push in pushes:
        middle = push.start + push.duration / 2
        if not free or not begin < middle < end:
            continue
        nearest = min(free, key=lambda panel: abs(times[panel] - middle))
        times[nearest] = middle
        free.remove(nearest)
    return sorted(times.tolist())
