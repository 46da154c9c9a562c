# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Checks of the arguments of a Simulation's methods, before anything is changed."""

from collections.abc import Callable
from collections.abc import Mapping
from collections.abc import Sequence

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.arguments import booleans
from cloth_sim_ros.sim.arguments import flag
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.arguments import mapping
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pose import checked_position
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import unit_quaternion
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import GIVE_SCENE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.sim.stepping import checked_steps
import numpy as np


def check_flags(**values: bool) -> None:
    """Raise ClothSimError unless each of ``values`` is True or False."""
    for name, value in values.items():
        flag(value, name)


def check_callable(**values: Callable[[], object]) -> None:
    """Raise ClothSimError unless each of ``values`` can be called."""
    for name, value in values.items():
        if not callable(value):
            raise ClothSimError(
                f'{name} must be a function, got {shown(value)}: give one without arguments')


def check_context(context: Context | None) -> None:
    """Raise ClothSimError unless ``context`` is one, or None for one of the caller's own."""
    if context is not None:
        instance(context, Context, 'the context', 'leave it out for one of its own')


def check_creation(scene: Scene, context: Context | None, **flags: bool) -> None:
    """Raise ClothSimError unless a Simulation can be made of these arguments."""
    instance(scene, Scene, 'what is simulated', GIVE_SCENE)
    check_context(context)
    check_flags(**flags)


def checked_run(
        scene: Scene, steps: int, pinned: np.ndarray, pushes: Sequence[Push],
        colliders: Mapping[str, Pose]) -> tuple[int, np.ndarray, list[Push]]:
    """
    Return steps, pins and pushes of the middle of a run, (rows, cols) bool for the pins.

    :raises ClothSimError: when one of the arguments is something else, or the scene has no
        collider of a name in ``colliders``
    """
    steps = checked_steps(steps, 0, scene['dt'])
    pinned = booleans(pinned, 'pinned', (scene.rows, scene.cols))
    hint = 'give those that Push.checked returns'
    checked = [
        Push.checked(**vars(instance(push, Push, 'each push', hint)))
        for push in iterable(pushes, 'the pushes', hint)]
    names = [collider.name for collider in scene.colliders]
    for name, pose in mapping(
            colliders, 'the colliders', "give their poses by name, {'table': Pose(...)}").items():
        if name not in names:
            raise ClothSimError(
                f'there is no collider {shown(name)}: give those of the scene, '
                f'{", ".join(names) or "none"}')
        instance(pose, Pose, f'the pose of collider {name}', 'write Pose(position, orientation)')
        checked_position(pose.position, f'the position of collider {name}')
        unit_quaternion(pose.orientation, f'the orientation of collider {name}')
    return steps, pinned, checked


def checked_snapshot(snapshot: Snapshot, time: float) -> Snapshot:
    """Return ``snapshot``; ClothSimError where it is not one of the present ``time`` [s]."""
    way_out = 'make one with snapshot(), or leave it out'
    instance(snapshot, Snapshot, 'the snapshot', way_out)
    if snapshot.time != time:
        raise ClothSimError(
            f'the forces at grasps need a snapshot of {time:g} s, got one of {snapshot.time:g} s: '
            f'{way_out}')
    return snapshot
