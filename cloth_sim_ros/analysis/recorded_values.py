# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is read of decoded messages: checked, as a bag brings its own definitions."""

from typing import Any

from cloth_sim_ros.analysis.frame_table import STATS
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.pose import checked_position
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import unit_quaternion
import numpy as np

# What ~/inputs/command can say.
RESET, CLEAR_PUSHES = 'reset', 'clear_pushes'
_NUMBER = (int, float)
_LIST = (list, tuple, np.ndarray)
_POINT = ('x', 'y', 'z')
_STAMP = {'header.stamp.sec': int, 'header.stamp.nanosec': int}
_VALUE = {
    'type': int, 'bool_value': int, 'integer_value': int, 'double_value': _NUMBER,
    'string_value': str, 'bool_array_value': _LIST, 'integer_array_value': _LIST,
    'double_array_value': _LIST, 'string_array_value': _LIST}
_PARAMETER = {'name': str, **{f'value.{name}': kind for name, kind in _VALUE.items()}}
_POSE = {
    **{f'pose.position.{axis}': _NUMBER for axis in _POINT},
    **{f'pose.orientation.{axis}': _NUMBER for axis in (*_POINT, 'w')}}
_FRAME_TARGET = {
    **_STAMP, 'name': str, **_POSE, 'keep_orientation': int, 'speed': _NUMBER,
    'angular_speed': _NUMBER}

# By topic: what is read, with the type that it must have.
_NEEDED: dict[str, dict[str, Any]] = {
    'points': {
        **_STAMP, 'height': int, 'width': int, 'point_step': int, 'is_bigendian': int,
        'data': np.ndarray},
    'stats': _STAMP,
    **dict.fromkeys(
        ('pins/wrenches', 'pins/peak_wrenches', 'grasps/wrenches', 'grasps/peak_wrenches',
         'colliders/wrenches'),
        {**_STAMP, 'header.frame_id': str,
         **{f'wrench.{part}.{axis}': _NUMBER for part in ('force', 'torque')
            for axis in _POINT}}),
    'state': {**_STAMP, 'rows': int, 'cols': int, 'mode': str, 'device': str, 'run_state': str},
    'inputs/push': {
        **_STAMP, 'region': str, 'start': _NUMBER, 'duration': _NUMBER, 'radius': _NUMBER,
        **{f'{name}.{axis}': _NUMBER for name in ('force', 'center') for axis in _POINT}},
    'inputs/pin': {**_STAMP, 'row': int, 'col': int, 'pinned': int},
    'inputs/pin_target': {
        **_STAMP, 'row': int, 'col': int, 'speed': _NUMBER,
        **{f'target.{axis}': _NUMBER for axis in _POINT}},
    'inputs/grasp': {
        **_STAMP, 'name': str, 'grasped': int, **_POSE, 'rows': _LIST, 'cols': _LIST,
        'max_force': _NUMBER, 'by_force': int},
    'inputs/grasp_target': _FRAME_TARGET,
    'inputs/collider_target': _FRAME_TARGET,
    'inputs/wind': {**_STAMP, **{f'vector.{axis}': _NUMBER for axis in _POINT}},
    'inputs/mode': {**_STAMP, 'mode': str},
    'inputs/command': {**_STAMP, 'command': str},
    'inputs/parameters': {'stamp.sec': int, 'stamp.nanosec': int},
    'inputs/time_base': {**_STAMP, 'epoch.sec': int, 'epoch.nanosec': int},
}
# Fields of the elements of list fields.
_ELEMENTS: dict[str, dict[str, dict[str, Any]]] = {
    'points': {'fields': {'name': str, 'datatype': int, 'offset': int}},
    'inputs/parameters': {'new_parameters': _PARAMETER, 'changed_parameters': _PARAMETER},
}
# Fields that messages of some versions lack.
_OPTIONAL: dict[str, dict[str, Any]] = {
    'inputs/mode': {'previous_mode': str}, 'stats': dict.fromkeys(STATS, _NUMBER)}


def check_message(key: str, message: Any) -> None:
    """
    Refuse a message that lacks what is read of it, or has it in another type.

    :param key: its topic, behind the name of the node
    :raises ClothSimError: when it does
    """
    _check(key, message, _NEEDED.get(key, {}))
    for name, kind in _OPTIONAL.get(key, {}).items():
        if hasattr(message, name):
            _check(key, message, {name: kind})
    for name, needed in _ELEMENTS.get(key, {}).items():
        _check(key, message, {name: list})
        for element in getattr(message, name):
            _check(f'{key}, {name}', element, needed)


def _check(where: str, message: Any, needed: dict[str, Any]) -> None:
    for name, kind in needed.items():
        value = message
        for part in name.split('.'):
            value = getattr(value, part, None)
        if not isinstance(value, kind):
            raise ClothSimError(
                f'a message on ~/{where} has {cut(shown(value), 40)} as its {name}, where '
                f'{_name_of(kind)} is expected: give a recording of a cloth_sim node')


def _name_of(kind: Any) -> str:
    kinds = kind if isinstance(kind, tuple) else (kind,)
    return {int: 'a whole number', float: 'a number', str: 'a word'}.get(kinds[-1], 'a list')


# Parameters, vectors and poses in decoded messages, as plain values.

# By the numbers of rcl_interfaces/msg/ParameterType.
_SLOTS = {
    1: ('bool_value', bool), 2: ('integer_value', int), 3: ('double_value', float),
    4: ('string_value', str)}
_ARRAY_SLOTS = {
    6: ('bool_array_value', bool), 7: ('integer_array_value', int),
    8: ('double_array_value', float), 9: ('string_array_value', str)}


def plain_value(value: Any) -> Any:
    """Return what the decoded ParameterValue ``value`` holds; None for what no parameter has."""
    if value.type in _SLOTS:
        slot, kind = _SLOTS[value.type]
        return kind(getattr(value, slot))
    if value.type in _ARRAY_SLOTS:
        slot, kind = _ARRAY_SLOTS[value.type]
        try:
            return [kind(part) for part in getattr(value, slot)]
        except (TypeError, ValueError):  # of a type that the bag has defined in another way
            return None
    return None


def parts(vector: Any) -> tuple[float, float, float]:
    """Return the components of a decoded Point or Vector3."""
    return (vector.x, vector.y, vector.z)


def recorded_pose(message: Any) -> Pose:
    """Return the decoded Pose ``message``; ClothSimError if it is none."""
    return Pose(
        checked_position(parts(message.position), 'a recorded position'),
        unit_quaternion(
            (*parts(message.orientation), message.orientation.w), 'a recorded orientation'))
