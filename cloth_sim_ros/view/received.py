# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a page may send: messages of known kinds, with fields of the right type and size."""

from collections.abc import Callable
import math
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
import msgspec.msgpack
import viser

# Max. magnitude of a number [1 or m]; simulations stop at 1e12 m as well.
_MOST = 1e12
# Min. length of a direction [1]; below it the ray of a click has no direction.
_SHORTEST = 1e-9

# Returns whether a field has a value that can be used.
Check = Callable[[Any], bool]


def problem_of(data: bytes | str, control: Callable[[str], Any]) -> str:
    """
    Return the fault of a message from a page; empty when viser may have it.

    viser itself sets any attribute of a control to any value, and moves handles to positions
    that have no place in space.

    :param data: as received
    :param control: returns viser's handle of the control with a given uuid, or None
    """
    if isinstance(data, str):
        return 'a text instead of a message'
    try:
        message = msgspec.msgpack.decode(data)
    except (msgspec.DecodeError, RecursionError, ValueError) as error:
        return f'bytes that are no message ({cut(error)})'
    if not isinstance(message, dict) or not isinstance(message.get('type'), str):
        return 'a message without a type'
    kind = message.pop('type')
    fields = _KINDS.get(kind)
    if fields is None:
        return f'a message of the kind {shown(kind)}, which this view does not serve'
    for name in fields.keys() - _OPTIONAL - message.keys():
        return f'a {kind} without {name}'
    for name, value in message.items():
        if name not in fields:
            return f'a {kind} with the unknown field {shown(name)}'
        if not fields[name](value):
            return f'a {kind} whose {name} is {shown(value)}'
    return _problem_of_control(message, control) if kind == 'GuiUpdateMessage' else ''


def _problem_of_control(message: dict[str, Any], control: Callable[[str], Any]) -> str:
    handle = control(message['uuid'])
    if handle is None:
        return f'a value for the unknown control {shown(message["uuid"])}'
    value = message['updates']['value']
    if isinstance(handle, (viser.GuiNumberHandle, viser.GuiSliderHandle)):
        is_right = _is_number(value)
    elif isinstance(handle, viser.GuiDropdownHandle):
        is_right = value in handle.options
    else:
        is_right = type(value) is type(handle.value)
    return '' if is_right else f'the value {shown(value)} for the control {shown(handle.label)}'


def _is_number(value: Any) -> bool:
    return type(value) in (int, float) and math.isfinite(value) and abs(value) <= _MOST


def _is_text(value: Any) -> bool:
    return isinstance(value, str)


def _numbers(count: int) -> Check:
    return lambda value: (
        isinstance(value, list) and len(value) == count and all(map(_is_number, value)))


def _or_none(check: Check) -> Check:
    return lambda value: value is None or check(value)


def _is_direction(value: Any) -> bool:
    return _numbers(3)(value) and math.hypot(*value) >= _SHORTEST


def _is_places(value: Any) -> bool:
    return isinstance(value, list) and all(map(_numbers(2), value))


def _is_update(value: Any) -> bool:
    return isinstance(value, dict) and value.keys() == {'value'}


_OPTIONAL = frozenset({'owner'})
_POSE: dict[str, Check] = {'wxyz': _numbers(4), 'position': _numbers(3)}
_HANDLE: dict[str, Check] = {'name': _is_text, 'owner': _is_text}
# Each kind of message that the page of this view sends, with its fields.
_KINDS: dict[str, dict[str, Check]] = {
    'ViewerCameraMessage': {
        **_POSE, 'fov': _is_number, 'near': _is_number, 'far': _is_number,
        'image_height': _is_number, 'image_width': _is_number, 'look_at': _numbers(3),
        'up_direction': _numbers(3)},
    'ScenePointerMessage': {
        'event_type': lambda value: value == 'click', 'ray_origin': _numbers(3),
        'ray_direction': _is_direction, 'screen_pos': _is_places,
        'modifier': _or_none(_is_text)},
    'GuiUpdateMessage': {'uuid': _is_text, 'updates': _is_update},
    'TransformControlsDragStartMessage': _HANDLE,
    'TransformControlsUpdateMessage': {**_HANDLE, **_POSE},
    'TransformControlsDragEndMessage': _HANDLE}
