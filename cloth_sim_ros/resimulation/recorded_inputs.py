# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The inputs of a recording, from decoded messages of its topics; needs no ROS."""

from collections.abc import Callable
from typing import Any

from cloth_sim_ros.analysis.recorded_values import CLEAR_PUSHES
from cloth_sim_ros.analysis.recorded_values import parts
from cloth_sim_ros.analysis.recorded_values import RESET
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import MoveGrasp
from cloth_sim_ros.sim.inputs import MovePin
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import SetWind
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.model.push import Push

# The largest number that a message has for a row or a column.
_LARGEST = 2**32 - 1


def recorded_push(message: Any) -> Push:
    """Return the push of a message of ~/inputs/push; ClothSimError if it is none."""
    return Push.checked(
        force=parts(message.force), start=message.start, duration=message.duration,
        region=message.region, center=parts(message.center), radius=message.radius)


def recorded_nodes(message: Any) -> tuple[tuple[int, int], ...]:
    """Return the nodes of a message of ~/inputs/grasp; ClothSimError if it has none."""
    rows, cols = list(message.rows), list(message.cols)
    try:
        nodes = tuple((int(row), int(col)) for row, col in zip(rows, cols))
    except (OverflowError, TypeError, ValueError):  # the bag has defined them in another way
        nodes = ()
    if not nodes or len(rows) != len(cols) or max(map(max, nodes)) > _LARGEST:
        raise ClothSimError(
            f'a recorded grasp has {len(rows)} rows and {len(cols)} columns of nodes: it needs as '
            'many numbers of each, record it again')
    return nodes


def recorded_input(key: str, message: Any) -> Input:
    """
    Return the input of a decoded message.

    :param key: of its topic, 'inputs/push'
    :raises ClothSimError: when the message has none, or one that this version does not know
    """
    return _READERS[key](message)


def _pin(message: Any) -> Input:
    row, col = int(message.row), int(message.col)
    return Pin(row, col) if message.pinned else Unpin(row, col)


def _pin_target(message: Any) -> Input:
    return MovePin(int(message.row), int(message.col), parts(message.target), message.speed)


def _grasp(message: Any) -> Input:
    if not message.grasped:
        return Release(message.name, bool(message.by_force))
    return TakeGrasp(
        message.name, parts(message.pose.position), _orientation(message),
        max_force=message.max_force, nodes=recorded_nodes(message))


def _frame_target(kind: type[MoveGrasp] | type[MoveCollider]) -> Callable[[Any], Input]:
    # A speed of 0 is the scene's.
    return lambda message: kind(
        message.name, parts(message.pose.position),
        None if message.keep_orientation else _orientation(message),
        message.speed or None, message.angular_speed or None)


def _orientation(message: Any) -> tuple[float, ...]:
    return (*parts(message.pose.orientation), message.pose.orientation.w)


def _mode(message: Any) -> Input:
    # Messages of some versions lack the mode before.
    return SetMode(message.mode, getattr(message, 'previous_mode', ''))


def _command(message: Any) -> Input:
    if message.command == RESET:
        return Reset()
    if message.command == CLEAR_PUSHES:
        return ClearPushes()
    raise ClothSimError(f'this version has no command {shown(message.command)}: it is ignored')


_READERS: dict[str, Callable[[Any], Input]] = {
    'inputs/push': lambda message: PushNodes(recorded_push(message)),
    'inputs/pin': _pin,
    'inputs/pin_target': _pin_target,
    'inputs/grasp': _grasp,
    'inputs/grasp_target': _frame_target(MoveGrasp),
    'inputs/collider_target': _frame_target(MoveCollider),
    'inputs/wind': lambda message: SetWind(parts(message.vector)),
    'inputs/mode': _mode,
    'inputs/command': _command,
}
