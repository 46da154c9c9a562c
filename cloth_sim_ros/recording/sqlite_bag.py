# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The messages of a bag that is an sqlite3 database."""

from collections.abc import Collection
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
import sqlite3
from typing import Any

from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import open_regular
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import RawMessage
from cloth_sim_ros.recording.bag_messages import recorded_qos
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

_FORMATS = {'ros2msg': MessageDefinitionFormat.MSG, 'ros2idl': MessageDefinitionFormat.IDL}
_NEEDED = {
    'topics': {'id', 'name', 'type'}, 'messages': {'id', 'topic_id', 'timestamp', 'data'}}
_DEFINITIONS = {'topic_type', 'encoding', 'encoded_message_definition'}
# A query may make so many steps, and so many for each byte of the file: sorting all messages
# takes a few hundred for each, and none is shorter than 10 bytes.
_SPARE_STEPS = 10_000_000
_STEPS_PER_BYTE = 30
_STEPS_AT_ONCE = 100_000


class SqliteBag:
    """
    Reads a file that was finished.

    ``problem`` says where reading had to end; it is empty while all went well.

    :raises OSError: when it is not there, or may not be read
    :raises ClothSimError: when it is no regular file
    :raises ValueError: when its tables are not those of a bag
    :raises sqlite3.Error: when sqlite3 can't read it
    """

    def __init__(self, path: Path) -> None:
        """Read what is in it."""
        self.path = path
        self.problem = ''
        with open_regular(path) as file:
            self._size = file.seek(0, 2)
        with closing(self._connection()) as database:
            columns = {name: _columns(database, name) for name in _NEEDED}
            for name, needed in _NEEDED.items():
                if not needed <= columns[name]:
                    raise ValueError(f'its table {name} lacks {", ".join(needed - columns[name])}')
            self._types: dict[int, tuple[str, str]] = {}
            self.topics = list(self._read_topics(database, columns['topics']))
            first, last = database.execute(
                'SELECT min(timestamp), max(timestamp) FROM messages').fetchone()
            # Times of the first and the last message [ns].
            self.span = None if first is None else (_checked(first, int), _checked(last, int))

    def messages(
            self, names: Collection[str] | None, begin: int | None = None,
            end: int | None = None) -> Iterator[RawMessage]:
        """
        Yield the messages of the topics ``names``, or of all, in the order of their times.

        Those from ``begin`` on and before ``end`` [ns], where these are given.
        """
        wanted = [
            number for number, (topic, _) in self._types.items()
            if names is None or topic in names]
        query = [
            'SELECT topic_id, timestamp, data FROM messages',
            f'WHERE topic_id IN ({", ".join(map(str, wanted))})']
        query += [] if begin is None else [f'AND timestamp >= {int(begin)}']
        query += [] if end is None else [f'AND timestamp < {int(end)}']
        try:
            with closing(self._connection()) as database:
                for number, time, data in database.execute(
                        ' '.join([*query, 'ORDER BY timestamp'])):
                    yield RawMessage(
                        *self._types[number], _checked(time, int), _checked(data, bytes))
        except Exception as error:  # a damaged byte can raise anything
            self.problem = (
                f'{self.path.name} is damaged: read up to there '
                f'({cut(error) or type(error).__name__})')

    def _read_topics(self, database: sqlite3.Connection, columns: set[str]) -> Iterator[BagTopic]:
        definitions = {}
        if _DEFINITIONS <= _columns(database, 'message_definitions'):
            definitions = {row[0]: row[1:] for row in database.execute(
                'SELECT topic_type, encoding, encoded_message_definition '
                'FROM message_definitions ORDER BY id DESC')}
        counts = dict(database.execute(
            'SELECT topic_id, count(*) FROM messages GROUP BY topic_id'))
        qos = 'offered_qos_profiles' if 'offered_qos_profiles' in columns else "''"
        for number, name, type_name, profiles in database.execute(
                f'SELECT id, name, type, {qos} FROM topics ORDER BY id'):
            self._types[_checked(number, int)] = _checked(name, str), _checked(type_name, str)
            encoding, text = definitions.get(type_name, ('', ''))
            kind = _FORMATS.get(encoding, MessageDefinitionFormat.NONE)
            yield BagTopic(
                name, type_name, recorded_qos(profiles), counts.get(number, 0),
                MessageDefinition(kind, text if isinstance(text, str) and kind in
                                  _FORMATS.values() else ''))

    def _connection(self) -> sqlite3.Connection:
        database = sqlite3.connect(
            f'{self.path.absolute().as_uri()}?mode=ro&immutable=1', uri=True)
        database.text_factory = lambda text: text.decode(errors='replace')
        left = (_SPARE_STEPS + _STEPS_PER_BYTE * self._size) // _STEPS_AT_ONCE

        def count_steps() -> bool:
            nonlocal left
            left -= 1
            return left < 0

        database.set_progress_handler(count_steps, _STEPS_AT_ONCE)
        return database


def _columns(database: sqlite3.Connection, table: str) -> set[str]:
    """Return the columns of ``table``; ValueError when it is none, or has computed columns."""
    kind = database.execute(
        'SELECT type, sql FROM sqlite_master WHERE name = ?', (table,)).fetchone()
    if kind is None:
        return set()
    columns = list(database.execute(f'PRAGMA table_xinfo({table})'))
    # A computed view or column can be larger than the file by any factor.
    if kind[0] != 'table' or str(kind[1]).upper().startswith('CREATE VIRTUAL') or any(
            column[6] for column in columns):
        raise ValueError(f'{table} is computed, and no plain table')
    return {column[1] for column in columns}


def _checked(value: Any, kind: type) -> Any:
    """Return ``value``; ValueError when it is not of ``kind``."""
    if not isinstance(value, kind):
        raise ValueError(
            f'{cut(shown(value), 40)} stands where {kind.__name__} belongs')
    return value
