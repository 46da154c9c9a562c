# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What was done to the cloth, as messages: a recording keeps them for running it again."""

from collections.abc import Iterable
from collections.abc import Mapping
from collections.abc import Sequence
from typing import Any

from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import FrameTarget
from cloth_sim_interfaces.msg import GraspChange
from cloth_sim_interfaces.msg import ModeChange
from cloth_sim_interfaces.msg import PinChange
from cloth_sim_interfaces.msg import PinTarget
from cloth_sim_interfaces.msg import Push as PushMessage
from cloth_sim_ros.messages.body_frames import pose_message
from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.grasps import Grasp
from cloth_sim_ros.sim.pins import PinMove
from cloth_sim_ros.sim.pose import NO_ROTATION
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.push import Push
from cloth_sim_ros.sim.scene_fields import Field
from geometry_msgs.msg import Point
from geometry_msgs.msg import Vector3
from geometry_msgs.msg import Vector3Stamped
from rcl_interfaces.msg import Parameter
from rcl_interfaces.msg import ParameterEvent
from rcl_interfaces.msg import ParameterType
from rcl_interfaces.msg import ParameterValue
from std_msgs.msg import Header

_SLOTS = {
    (bool, False): (ParameterType.PARAMETER_BOOL, 'bool_value'),
    (int, False): (ParameterType.PARAMETER_INTEGER, 'integer_value'),
    (float, False): (ParameterType.PARAMETER_DOUBLE, 'double_value'),
    (str, False): (ParameterType.PARAMETER_STRING, 'string_value'),
    (bool, True): (ParameterType.PARAMETER_BOOL_ARRAY, 'bool_array_value'),
    (int, True): (ParameterType.PARAMETER_INTEGER_ARRAY, 'integer_array_value'),
    (float, True): (ParameterType.PARAMETER_DOUBLE_ARRAY, 'double_array_value'),
    (str, True): (ParameterType.PARAMETER_STRING_ARRAY, 'string_array_value'),
}


def parameter_value(field: Field, value: Any) -> ParameterValue:
    """Return ``value`` with the type of ``field``: an empty list alone does not tell its type."""
    is_list = field.is_array or (field.is_pair and isinstance(value, tuple))
    kind, slot = _SLOTS[field.kind, is_list]
    content = [field.kind(part) for part in value] if is_list else field.kind(value)
    return ParameterValue(type=kind, **{slot: content})


def serialise_parameter_event(event: ParameterEvent) -> bytes:
    """
    Return the CDR bytes of ``event``.

    Those of the middleware are longer than the message, and strict readers such as rosbags refuse
    them.
    """
    writer = CdrWriter()
    writer.put('i', event.stamp.sec)
    writer.put('I', event.stamp.nanosec)
    writer.put_string(event.node)
    for parameters in (
            event.new_parameters, event.changed_parameters, event.deleted_parameters):
        writer.put('I', len(parameters))
        for parameter in parameters:
            _put_parameter(writer, parameter)
    return writer.finish()


def _put_parameter(writer: CdrWriter, parameter: Parameter) -> None:
    value: ParameterValue = parameter.value
    writer.put_string(parameter.name)
    writer.put('B', value.type)
    writer.put('?', value.bool_value)
    writer.put('q', value.integer_value)
    writer.put('d', value.double_value)
    writer.put_string(value.string_value)
    _put_numbers(writer, 'B', [byte[0] for byte in value.byte_array_value])
    _put_numbers(writer, '?', value.bool_array_value)
    _put_numbers(writer, 'q', value.integer_array_value)
    _put_numbers(writer, 'd', value.double_array_value)
    writer.put('I', len(value.string_array_value))
    for text in value.string_array_value:
        writer.put_string(text)


def _put_numbers(writer: CdrWriter, code: str, numbers: Any) -> None:
    writer.put('I', len(numbers))
    # Of an empty list nothing follows, not even what would align its elements.
    if len(numbers):
        writer.put(code, *numbers)


def push_message(push: Push, sim_time: float, frame_id: str) -> PushMessage:
    """Return ``push``, which was given at ``sim_time`` [s]."""
    return PushMessage(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id),
        force=Vector3(x=push.force[0], y=push.force[1], z=push.force[2]),
        region=push.region,
        center=Point(x=push.center[0], y=push.center[1], z=push.center[2]),
        radius=push.radius,
        start=push.start,
        duration=push.duration)


def pin_message(row: int, col: int, pinned: bool, sim_time: float, frame_id: str) -> PinChange:
    """Return the pinning, or the release, of one node at ``sim_time`` [s]."""
    return PinChange(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), row=row, col=col, pinned=pinned)


def pin_target_message(move: PinMove, sim_time: float, frame_id: str) -> PinTarget:
    """Return ``move``, which was given at ``sim_time`` [s] or goes on from there."""
    x, y, z = move.target
    return PinTarget(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), row=move.row, col=move.col,
        target=Point(x=x, y=y, z=z), speed=move.speed)


def grasp_message(grasp: Grasp, sim_time: float, frame_id: str) -> GraspChange:
    """Return ``grasp``, which began at ``sim_time`` [s] or holds its nodes there."""
    rows, cols = grasp.nodes.T.tolist()
    return GraspChange(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), name=grasp.name, grasped=True,
        pose=pose_message(grasp.pose), rows=rows, cols=cols, max_force=grasp.max_force)


def release_message(
        name: str, by_force: bool, sim_time: float, frame_id: str) -> GraspChange:
    """Return the end of the grasp ``name`` at ``sim_time`` [s]."""
    return GraspChange(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), name=name, by_force=by_force)


def frame_target_message(move: FrameMove, sim_time: float, frame_id: str) -> FrameTarget:
    """Return ``move``, which was given at ``sim_time`` [s] or goes on from there."""
    return FrameTarget(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), name=move.name,
        pose=pose_message(Pose(move.target, move.orientation or NO_ROTATION)),
        keep_orientation=move.orientation is None, speed=move.speed,
        angular_speed=move.angular_speed)


def place_message(name: str, pose: Pose, sim_time: float, frame_id: str) -> FrameTarget:
    """Return that the collider ``name`` is at ``pose`` at ``sim_time`` [s]."""
    return FrameTarget(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), name=name,
        pose=pose_message(pose))


def wind_message(
        velocity: Sequence[float], sim_time: float, frame_id: str) -> Vector3Stamped:
    """Return the steady wind from ``sim_time`` [s] on, ``velocity`` [m/s]."""
    x, y, z = velocity
    return Vector3Stamped(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), vector=Vector3(x=x, y=y, z=z))


def mode_message(mode: str, previous_mode: str, sim_time: float, frame_id: str) -> ModeChange:
    """Return the switch of the mode at ``sim_time`` [s]."""
    return ModeChange(
        header=Header(stamp=stamp(sim_time), frame_id=frame_id), mode=mode,
        previous_mode=previous_mode)


def command_message(command: str, sim_time: float, frame_id: str) -> Command:
    """Return Command.RESET or Command.CLEAR_PUSHES, given at ``sim_time`` [s]."""
    return Command(header=Header(stamp=stamp(sim_time), frame_id=frame_id), command=command)


def parameters_message(
        values: Mapping[str, Any], fields: Iterable[Field], sim_time: float, node_name: str, *,
        is_change: bool = False) -> ParameterEvent:
    """
    Return the parameters in ``values``, typed as ``fields`` has them.

    :param values: by name; names that ``fields`` lacks are left out
    :param node_name: with its namespace
    :param is_change: True for a change while running, False for what holds from here on
    """
    parameters = [
        Parameter(name=field.name, value=parameter_value(field, values[field.name]))
        for field in fields if field.name in values]
    event = ParameterEvent(stamp=stamp(sim_time), node=f'/{node_name.lstrip("/")}')
    if is_change:
        event.changed_parameters = parameters
    else:
        event.new_parameters = parameters
    return event
