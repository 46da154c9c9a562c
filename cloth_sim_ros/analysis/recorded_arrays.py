# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The messages of a recorded topic as NumPy arrays, one entry for each message."""

from collections.abc import Iterable
from collections.abc import Iterator
from dataclasses import fields
from dataclasses import is_dataclass
from typing import Any

from cloth_sim_ros.analysis.entry import Entry
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.messages.frame_names import node_of_pin
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

_VECTORS = {
    'positions': ('x', 'y', 'z'), 'velocities': ('vx', 'vy', 'vz'),
    'normals': ('normal_x', 'normal_y', 'normal_z')}


def arrays_of(key: str, entries: Iterable[Entry]) -> dict[str, np.ndarray]:
    """Return the arrays of ``entries``, all of the topic ``key``; Recording.arrays tells more."""
    return (_of_points if key == 'points' else _of_messages)(entries)


def _of_points(entries: Iterable[Entry]) -> dict[str, np.ndarray]:
    times: list[float] = []
    resets: list[int] = []
    frames: list[np.ndarray] = []
    for entry in entries:
        records = Frame.from_points(entry.time, entry.message).records
        if frames and records.shape != frames[0].shape:
            raise ClothSimError(
                f'a cloud of {records.shape[0]} x {records.shape[1]} nodes at {entry.time:g} s '
                f'follows one of {frames[0].shape[0]} x {frames[0].shape[1]}: read them one by '
                'one, with Recording.entries')
        times.append(entry.time)
        resets.append(entry.resets)
        frames.append(records)
    names = frames[0].dtype.names or () if frames else ()
    arrays = {'time': np.array(times, float), 'resets': np.array(resets, int)}
    for name, parts in _VECTORS.items():
        if set(parts) <= set(names):
            arrays[name] = np.stack([
                np.stack([records[part] for part in parts], axis=-1) for records in frames])
    for name in ('strain', 'flags'):
        if name in names:
            arrays[name] = np.stack([records[name] for records in frames])
    return arrays


def _of_messages(entries: Iterable[Entry]) -> dict[str, np.ndarray]:
    columns: dict[str, list[Any]] = {'time': [], 'resets': []}
    for entry in entries:
        columns['time'].append(entry.time)
        columns['resets'].append(entry.resets)
        for name, value in _values(entry.message):
            columns.setdefault(name, []).append(value)
    return {name: np.array(values) for name, values in columns.items()}


def _values(message: Any, prefix: str = '') -> Iterator[tuple[str, Any]]:
    """Yield what a column can hold; the stamp is the time already, and lists have no one shape."""
    for field in fields(message):
        # Constants of the message, and its type.
        if field.name.isupper() or field.name.startswith('_'):
            continue
        value = getattr(message, field.name)
        name = f'{prefix}{field.name}'
        if name == 'stamp':
            continue
        if name == 'header':
            pin = node_of_pin(value.frame_id)
            if pin is not None:
                yield from zip(('row', 'col'), pin)
        elif isinstance(value, (bool, int, float, str)):
            yield name, value
        elif is_dataclass(value):
            parts = [getattr(value, axis, None) for axis in 'xyz']
            if None in parts:
                yield from _values(value, f'{name}.')
            else:
                yield name, parts
