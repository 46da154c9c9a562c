# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording to read: messages of one node, one in memory at a time or all as arrays."""

from collections.abc import Iterable
from collections.abc import Iterator
from dataclasses import dataclass
from dataclasses import fields
from dataclasses import is_dataclass
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from typing import Any
from typing import TYPE_CHECKING

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recorded_values import check_message
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.messages.frame_names import name_of_body
from cloth_sim_ros.messages.frame_names import node_of_pin
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recording_faults import nothing_flushed
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import path as checked_path
from cloth_sim_ros.sim.arguments import word
from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Entry:
    """
    One message of a recording.

    :param key: the topic behind the name of the node, such as points or inputs/push
    :param time: [s] simulated, continuing across resets
    :param message: decoded
    :param resets: of the run, before this message
    """

    key: str
    time: float
    message: Any
    resets: int = 0


# The messages of a recorded topic as NumPy arrays, one entry for each message.

_VECTORS = {
    'positions': ('x', 'y', 'z'), 'velocities': ('vx', 'vy', 'vz'),
    'normals': ('normal_x', 'normal_y', 'normal_z')}


def arrays_of(key: str, entries: Iterable[Entry]) -> dict[str, np.ndarray]:
    """Return the arrays of ``entries``, all of the topic ``key``; Recording.arrays tells more."""
    return _of_points(entries) if key == 'points' else _of_messages(key, entries)


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


def _of_messages(key: str, entries: Iterable[Entry]) -> dict[str, np.ndarray]:
    columns: dict[str, list[Any]] = {'time': [], 'resets': []}
    for entry in entries:
        columns['time'].append(entry.time)
        columns['resets'].append(entry.resets)
        for name, value in _values(key, entry.message):
            columns.setdefault(name, []).append(value)
    return {name: np.array(values) for name, values in columns.items()}


def _values(key: str, message: Any, prefix: str = '') -> Iterator[tuple[str, Any]]:
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
            yield from _of_frame(key, value.frame_id)
        elif isinstance(value, (bool, int, float, str)):
            yield name, value
        elif is_dataclass(value):
            yield from _values(key, value, f'{name}.')


def _of_frame(key: str, frame: str) -> Iterator[tuple[str, Any]]:
    """Yield the frame of a message of the topic ``key``, and the name of its node or body."""
    yield 'frame_id', frame
    topic, _, is_wrench = key.partition('/')
    if is_wrench and topic == 'pins':
        yield from zip(('row', 'col'), node_of_pin(frame) or (-1, -1))
    elif is_wrench and topic in ('grasps', 'colliders'):
        yield 'name', name_of_body(frame, topic[:-1])


def table_of(arrays: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return what ``arrays_of`` returns as columns, a row for each message or frame and node."""
    if 'positions' not in arrays and 'strain' not in arrays:
        return arrays
    shape = next(values.shape[:3] for values in arrays.values() if values.ndim > 2)
    frame, row, col = (each.ravel() for each in np.indices(shape))
    columns = {
        'time': arrays['time'][frame], 'resets': arrays['resets'][frame], 'row': row, 'col': col}
    for name, values in arrays.items():
        if name in _VECTORS:
            columns.update(zip(_VECTORS[name], values.reshape(-1, 3).T))
        elif values.ndim == 3:
            columns[name] = values.ravel()
    return columns


# A recording to read: messages of one node, from first to last, one in memory at a time.

_OWN = 'cloth_sim_interfaces/msg/'

# The type of each topic behind the node's name: a recording is read without the interfaces.
TYPES = {
    'points': 'sensor_msgs/msg/PointCloud2',
    'markers': 'visualization_msgs/msg/MarkerArray',
    'topology': 'shape_msgs/msg/Mesh',
    'stats': f'{_OWN}ClothStats',
    'pins/wrenches': 'geometry_msgs/msg/WrenchStamped',
    'pins/peak_wrenches': 'geometry_msgs/msg/WrenchStamped',
    'grasps/wrenches': 'geometry_msgs/msg/WrenchStamped',
    'grasps/peak_wrenches': 'geometry_msgs/msg/WrenchStamped',
    'colliders/wrenches': 'geometry_msgs/msg/WrenchStamped',
    'state': f'{_OWN}ClothState',
    'inputs/push': f'{_OWN}Push',
    'inputs/pin': f'{_OWN}PinChange',
    'inputs/pin_target': f'{_OWN}PinTarget',
    'inputs/grasp': f'{_OWN}GraspChange',
    'inputs/grasp_target': f'{_OWN}FrameTarget',
    'inputs/collider_target': f'{_OWN}FrameTarget',
    'inputs/wind': 'geometry_msgs/msg/Vector3Stamped',
    'inputs/mode': f'{_OWN}ModeChange',
    'inputs/command': f'{_OWN}Command',
    'inputs/parameters': 'rcl_interfaces/msg/ParameterEvent',
    'inputs/time_base': f'{_OWN}TimeBase',
}


_TIME_BASE = 'inputs/time_base'
_SECOND = 1_000_000_000  # [ns]


def _in_nanoseconds(stamp: Any) -> int:
    return int(stamp.sec) * _SECOND + int(stamp.nanosec)


def _take_off(message: Any, epoch: int) -> None:
    """Stamp ``message`` with the time since ``epoch`` [ns]."""
    holder = message.header if hasattr(message, 'header') else message
    if epoch and hasattr(holder, 'stamp'):
        sec, nanosec = divmod(_in_nanoseconds(holder.stamp) - epoch, _SECOND)
        holder.stamp = replace(holder.stamp, sec=sec, nanosec=nanosec)


class SteadyTime:
    """
    Turns the stamps of a recording, one behind the other, into times that go on over resets.

    A reset puts the stamps back to 0, of every topic. Messages of one topic come in their order;
    those of several may not, when another program recorded them: one that is late is no reset.
    """

    def __init__(self) -> None:
        """Begin before the first message."""
        self.now = 0.0
        self.resets = 0        # before the message read last
        self._offsets = [0.0]  # of each span between two resets
        self._latest = 0.0     # time of any message
        self._last: dict[str, tuple[float, int]] = {}

    def read(self, stamp: Any, topic: str = '') -> float:
        """Return the time [s] of the next message of ``topic``, which is stamped ``stamp``."""
        stamped = stamp.sec + 1e-9 * stamp.nanosec
        before, span = self._last.get(topic, (0.0, 0))
        if stamped < before:
            span += 1
            if span == len(self._offsets):
                self._offsets.append(self._latest)
        # A topic that is seldom sent learns of a reset from the others.
        span = min(
            range(span, len(self._offsets)),
            key=lambda later: abs(stamped + self._offsets[later] - self._latest))
        self._last[topic] = stamped, span
        self.resets = span
        self.now = stamped + self._offsets[span]
        self._latest = max(self._latest, self.now)
        return self.now


def find_node(topics: Iterable[BagTopic], path: Path) -> str:
    """
    Return the name of the one node that could have sent ``topics``, with its namespace.

    A topic of one of this project's types tells best; points alone count where there is none.

    :param path: of the bag, for the errors
    :raises ClothSimError: when there is none, or several
    """
    certain = set()
    possible = set()
    for topic in topics:
        for key, type_name in TYPES.items():
            node = topic.name.removesuffix(f'/{key}')
            if node == topic.name or type_name != topic.type_name:
                continue
            if type_name.startswith(_OWN):
                certain.add(node)
            elif key == 'points':
                possible.add(node)
    nodes = sorted(certain or possible)
    if not nodes:
        raise ClothSimError(
            f'{path} holds no frame of a cloth_sim node, as it has no topic like '
            '/cloth_sim/points or /cloth_sim/stats: give a recording of one')
    if len(nodes) > 1:
        raise ClothSimError(
            f'{path} holds several nodes ({", ".join(nodes)}): name one with --node')
    return nodes[0]


class Recording:
    """
    A bag with the topics of a cloth_sim node: this project's, or of `ros2 bag record`.

    A truncated recording is read up to its last complete record.

    :param path: folder with mcap or sqlite3 files, or one such file
    :param node: name of the node, with its namespace; None finds it
    :raises ClothSimError: when nothing can be read
    """

    def __init__(self, path: str | Path, node: str | None = None) -> None:
        """Open the files."""
        self.path = checked_path(path, 'the recording')
        if node is not None:
            word(node, 'the name of the node', 'leave it out to have it found')
        self._bag = BagReader(self.path)
        self._given_node = node

    @cached_property
    def node(self) -> str:
        """Get the name of the node; ClothSimError when several could be meant, or none."""
        if self._given_node is not None:
            return f'/{self._given_node.strip("/")}'
        if not self.topics:
            raise self._bag.no_message()
        return find_node(self.topics, self.path)

    @property
    def name(self) -> str:
        """Get a name to tell recordings apart: that of the folder, or of the file."""
        path = self.path.resolve()
        return path.stem if path.is_file() else path.name

    @property
    def topics(self) -> list[BagTopic]:
        """Get all topics of the bag, with their types and the qualities of service offered."""
        return self._bag.topics

    @property
    def problems(self) -> list[str]:
        """Get what could not be read, one sentence each; complete when all has been read."""
        return self._bag.problems

    def count(self, *keys: str) -> int:
        """Return the number of messages of the topics ``keys``."""
        return sum(topic.count for topic in self._known_topics(keys))

    def keys(self) -> set[str]:
        """Return the topics of the node that are in the bag and of the type they should be."""
        return {topic.name[len(self.node) + 1:] for topic in self._known_topics(TYPES)}

    def entries(self, *keys: str) -> Iterator[Entry]:
        """
        Yield the messages of the topics ``keys``, stamped with simulated time.

        Where the node had other stamps, such as those of the wall clock, their epoch is taken off.
        Topics of another type than the node's are skipped.

        :raises ClothSimError: when a message makes no sense
        """
        # Resets are always read: the time must not depend on what else is.
        names = {
            topic.name: topic.type_name
            for topic in self._known_topics((*keys, 'inputs/command', _TIME_BASE))}
        begin = len(self.node) + 1
        time = SteadyTime()
        epoch = self._first_epoch()
        for raw in self._bag.messages(names) if names else ():
            if raw.type_name != names[raw.topic]:
                continue
            message = self._bag.decode(raw)
            key = raw.topic[begin:]
            check_message(key, message)
            if key == _TIME_BASE:
                epoch = _in_nanoseconds(message.epoch)
            _take_off(message, epoch)
            if hasattr(message, 'header'):
                time.read(message.header.stamp, raw.topic)
            if key in keys:
                yield Entry(key, time.now, message, time.resets)

    def arrays(self, key: str) -> dict[str, np.ndarray]:
        """
        Return all messages of the topic ``key`` as arrays, the first axis of which is the message.

        All have ``time`` [s], simulated and continuing across resets, and
        ``resets`` before the message. ``points`` has positions [m], velocities [m/s] and normals,
        (frames, rows, cols, 3), strain and flags, (frames, rows, cols), of the type recorded.
        Others have a column for each number or text of their messages, such as
        ``wrench.force.x`` [N], and ``frame_id`` where they have a header: ``pandas.DataFrame``
        takes them as they are. Wrenches of pins have row and col, those of grasps and colliders
        name.

        :raises ClothSimError: when the recording has no such topic, or a message makes no sense
        """
        if word(key, 'the topic') not in self.keys():
            raise ClothSimError(
                f'{cut(self.path)} holds no topic {cut(key)} of the node {self.node}: choose one '
                f'of {", ".join(sorted(self.keys()))}')
        return arrays_of(key, self.entries(key))

    def frame(self, key: str) -> 'pandas.DataFrame':
        """
        Return the topic ``key`` as a pandas.DataFrame with the columns of ``arrays``.

        It has a row for each message. ``points`` has one for each frame and node, with time,
        resets, row, col, x, y, z, vx and so on.

        :raises ClothSimError: as ``arrays`` does, and where pandas is not installed
        """
        try:
            import pandas
        except ImportError:
            raise ClothSimError(
                'Recording.frame makes tables of pandas, which is not installed: run `pip install '
                'pandas`, or take Recording.arrays') from None
        return pandas.DataFrame(table_of(self.arrays(key)))

    def raw_messages(self) -> Iterator[RawMessage]:
        """Yield all messages of all topics as they were recorded, of other nodes too."""
        return self._bag.messages()

    def decode(self, message: RawMessage) -> Any:
        """Return the decoded message; ClothSimError when it can't be."""
        instance(message, RawMessage, 'the message', 'give one of raw_messages()')
        return self._bag.decode(message)

    def no_frame(self) -> ClothSimError:
        """Return the error of those who find no frame of the cloth."""
        if not any(topic.count for topic in self.topics):
            return self._bag.no_message()
        if self.problems and not self.count('stats', 'points'):
            return nothing_flushed(self.path, 'holds no frame of the cloth')
        if self.problems:
            return ClothSimError(
                f'{cut(self.path)} holds no frame of the node {self.node} that can be read '
                f'({self.problems[0]}): give another recording')
        return ClothSimError(
            f'{self.path} holds no frame of the node {self.node}: name the recorded node with '
            '--node, or record with publish.points: true')

    def _first_epoch(self) -> int:
        """Return the stamp of simulated time 0 [ns] at the beginning of the recording."""
        # Another recorder may have it behind the first messages of other topics.
        for topic in self._known_topics([_TIME_BASE]):
            for raw in self._bag.messages([topic.name]):
                message = self._bag.decode(raw)
                check_message(_TIME_BASE, message)
                return _in_nanoseconds(message.epoch)
        return 0

    def _known_topics(self, keys: Iterable[str]) -> list[BagTopic]:
        keys = list(keys)
        for key in keys:
            if word(key, 'the topic') not in TYPES:
                raise ClothSimError(
                    f'a node has no topic {cut(key)}: choose one of {", ".join(TYPES)}')
        wanted = {f'{self.node}/{key}': TYPES[key] for key in keys}
        return [
            topic for topic in self.topics if wanted.get(topic.name) == topic.type_name]
