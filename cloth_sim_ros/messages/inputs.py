# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Accepted inputs as messages, which a recording keeps for running it again."""

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
from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import MoveFrame
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
from cloth_sim_ros.sim.model.pose import NO_ROTATION
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.scene_fields import Field
from geometry_msgs.msg import Point
from geometry_msgs.msg import Pose as PoseMessage
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
    # An empty list has neither elements nor padding.
    if len(numbers):
        writer.put(code, *numbers)


def input_message(
        given: Input, time: float, frame_id: str, epoch: int = 0) -> tuple[str, Any] | None:
    """
    Return the topic and the message of an accepted input; None where it has changed nothing.

    :param time: simulated time from which it acts [s]
    :param frame_id: of the cloth
    :param epoch: stamp of simulated time 0 [ns]
    :raises TypeError: for an input that has no message
    """
    header = Header(stamp=stamp(time, epoch), frame_id=frame_id)
    match given:
        case PushNodes(push):
            return 'inputs/push', PushMessage(
                header=header, force=Vector3(**_xyz(push.force)), region=push.region,
                center=Point(**_xyz(push.center)), radius=push.radius, start=push.start,
                duration=push.duration)
        case Pin(row, col) | Unpin(row, col):
            return 'inputs/pin', PinChange(
                header=header, row=row, col=col, pinned=isinstance(given, Pin))
        case MovePin(row, col, target, speed):
            return 'inputs/pin_target', PinTarget(
                header=header, row=row, col=col, target=Point(**_xyz(target)), speed=speed)
        case TakeGrasp(name, position, orientation, nodes=nodes):
            rows, cols = zip(*nodes or ())
            return 'inputs/grasp', GraspChange(
                header=header, name=name, grasped=True,
                pose=_pose(position, orientation),
                rows=rows, cols=cols, max_force=given.max_force)
        case Release(name, by_force):
            return 'inputs/grasp', GraspChange(header=header, name=name, by_force=by_force)
        case MoveGrasp():
            return 'inputs/grasp_target', _frame_target(given, header)
        case MoveCollider():
            return 'inputs/collider_target', _frame_target(given, header)
        case SetWind(velocity):
            return 'inputs/wind', Vector3Stamped(header=header, vector=Vector3(**_xyz(velocity)))
        case SetMode(mode, previous):
            return None if mode == previous else (
                'inputs/mode', ModeChange(header=header, mode=mode, previous_mode=previous))
        case Reset():
            return 'inputs/command', Command(header=header, command=Command.RESET)
        case ClearPushes():
            return 'inputs/command', Command(header=header, command=Command.CLEAR_PUSHES)
    raise TypeError(f'{type(given).__name__} has no message')


def _frame_target(given: MoveFrame, header: Header) -> FrameTarget:
    return FrameTarget(
        header=header, name=given.name,
        pose=_pose(given.target, given.orientation),
        keep_orientation=given.orientation is None, speed=given.speed,
        angular_speed=given.angular_speed)


def place_message(
        name: str, pose: Pose, sim_time: float, frame_id: str, epoch: int = 0) -> FrameTarget:
    """Return that the collider ``name`` is at ``pose`` ``sim_time`` [s] after ``epoch`` [ns]."""
    return FrameTarget(
        header=Header(stamp=stamp(sim_time, epoch), frame_id=frame_id), name=name,
        pose=pose_message(pose))


def _pose(position: Sequence[float], orientation: Sequence[float] | None) -> PoseMessage:
    x, y, z = map(float, position)
    qx, qy, qz, qw = map(float, orientation or NO_ROTATION)
    return pose_message(Pose((x, y, z), (qx, qy, qz, qw)))


def _xyz(values: Sequence[float]) -> dict[str, float]:
    return {name: float(value) for name, value in zip('xyz', values)}


def parameters_message(
        values: Mapping[str, Any], fields: Iterable[Field], sim_time: float, node_name: str, *,
        is_change: bool = False, epoch: int = 0) -> ParameterEvent:
    """
    Return the parameters in ``values``, typed as ``fields`` has them.

    :param values: by name; names that ``fields`` lacks are left out
    :param node_name: with its namespace
    :param is_change: True for a change while running, False for what holds from here on
    :param epoch: stamp of simulated time 0 [ns]
    """
    parameters = [
        Parameter(name=field.name, value=parameter_value(field, values[field.name]))
        for field in fields if field.name in values]
    event = ParameterEvent(stamp=stamp(sim_time, epoch), node=f'/{node_name.lstrip("/")}')
    if is_change:
        event.changed_parameters = parameters
    else:
        event.new_parameters = parameters
    return event
