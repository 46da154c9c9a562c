# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Bags of other programs, with any types on any topics."""

from cloth_sim_ros.recording.message_definition import message_definition
from rclpy.serialization import serialize_message
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer
from rosbags.typesys import get_types_from_msg
from rosbags.typesys import get_typestore
from rosbags.typesys import Stores


def write_bag(folder, messages, storage=StoragePlugin.MCAP, begin=10**18, interval=1):
    """
    Write a bag and return its folder.

    :param messages: each a topic and a message of rclpy, or a topic and a `made` one; a message
        of None makes the topic alone
    :param begin: log time of the first message [ns]
    :param interval: between the log times of two messages [ns]
    """
    with Writer(folder, version=9, storage_plugin=storage) as writer:
        connections = {}
        for number, (topic, message) in enumerate(messages):
            type_name, text, data = message if isinstance(message, tuple) else own(message)
            if topic not in connections:
                store = get_typestore(Stores.EMPTY)
                store.register(get_types_from_msg(text, type_name))
                connections[topic] = writer.add_connection(topic, type_name, typestore=store)
            if data is not None:
                writer.write(connections[topic], begin + number * interval, data)
    return folder


def own(message):
    """Return type, definition and bytes of a message of rclpy, or of its class without bytes."""
    kind = message if isinstance(message, type) else type(message)
    type_name = f'{kind.__module__.split(".")[0]}/msg/{kind.__name__}'
    data = None if isinstance(message, type) else serialize_message(message)
    return type_name, message_definition(type_name), data


def made(type_name, text, **fields):
    """Return a message of a type that is defined by ``text``; a dict is a message in it."""
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(text, type_name))

    def filled(name, values):
        kinds = {each: desc[1] for each, desc in store.fielddefs[name][1]}
        return store.types[name](**{
            each: filled(kinds[each], value) if isinstance(value, dict) else value
            for each, value in values.items()})

    return type_name, text, bytes(store.serialize_cdr(filled(type_name, fields), type_name))
