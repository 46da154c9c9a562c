# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Parameters, vectors and poses in decoded messages, as plain values."""

from typing import Any

from cloth_sim_ros.sim.pose import checked_position
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.pose import unit_quaternion

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
