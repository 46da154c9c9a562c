# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colliders of a recording, where they are at each time."""

from dataclasses import replace
import math
from typing import Any

from cloth_sim_ros.analysis.recorded_values import plain_value
from cloth_sim_ros.analysis.recorded_values import recorded_pose
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.sim.colliders import Collider
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.colliders import NAMES
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.frame_paths import FramePaths
from cloth_sim_ros.sim.handling import RESET
from cloth_sim_ros.sim.scene import Scene

_PARAMETERS, _TARGETS, _COMMANDS = (
    'inputs/parameters', 'inputs/collider_target', 'inputs/command')
KEYS = (_PARAMETERS, _TARGETS, _COMMANDS)
# The parameters that tell what the colliders are, and how the scene moves them.
_GROUPS = ('colliders', 'collider_moves', 'motion')


class ColliderHistory:
    """
    Takes up the messages of the topics KEYS one after the other.

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
        """Take up one message."""
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
        known = {field.name for field in fields_with_colliders(given)}
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
