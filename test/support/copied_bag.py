# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A recording once more, as `ros2 bag record` would have written it."""

from rosbags.interfaces import ConnectionExtRosbag2
from rosbags.rosbag2 import CompressionFormat
from rosbags.rosbag2 import CompressionMode
from rosbags.rosbag2 import Reader
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores

WALL = 1_790_000_000_000_000_000  # [ns] of some day
FACTOR = 3                        # wall time in a second of simulated time


def copy_bag(
        source, target, storage='mcap', *, topics=None, renamed=None, split=1,
        compression=None, delays=None):
    """
    Write the bag ``source`` anew with times of the wall clock; return ``target``.

    :param storage: mcap or sqlite3
    :param topics: those to keep; None keeps all
    :param renamed: new names of topics by their old ones
    :param split: number of files
    :param delays: by which messages of topics come late in wall time [ns], by name
    :param compression: FILE or MESSAGE, of a bag as old as Humble's; None for none
    """
    plugin = {'mcap': StoragePlugin.MCAP, 'sqlite3': StoragePlugin.SQLITE3}[storage]
    with Reader(source) as reader:
        messages = [
            (connection, WALL + FACTOR * time + (delays or {}).get(connection.topic, 0), data)
            for connection, time, data in reader.messages()
            if topics is None or connection.topic in topics]
        messages.sort(key=lambda message: message[1])
        part = -(-len(messages) // split)
        folders = []
        for number in range(split):
            folder = target if split == 1 else target.with_name(f'{target.name}_{number}')
            folders.append(folder)
            write_bag(
                folder, plugin, messages[number * part:(number + 1) * part], renamed or {},
                compression)
    if split > 1:
        target.mkdir()
        for folder in folders:
            file, = (path for path in folder.iterdir() if path.suffix in ('.mcap', '.db3'))
            file.rename(target / file.name)
    return target


def write_bag(folder, plugin, messages, renamed, compression):
    """Write ``messages``, each a connection of rosbags, a time [ns] and CDR bytes."""
    writer = Writer(folder, version=8 if compression else 9, storage_plugin=plugin)
    if compression:
        writer.set_compression(CompressionMode[compression], CompressionFormat.ZSTD)
    with writer:
        made = {}
        for connection, time, data in messages:
            if connection.id not in made:
                store = get_typestore(Stores.EMPTY)
                store.register(get_types_from_msg(connection.msgdef.data, connection.msgtype))
                assert isinstance(connection.ext, ConnectionExtRosbag2)
                made[connection.id] = writer.add_connection(
                    renamed.get(connection.topic, connection.topic), connection.msgtype,
                    typestore=store, offered_qos_profiles=connection.ext.offered_qos_profiles)
            writer.write(made[connection.id], time, data)
