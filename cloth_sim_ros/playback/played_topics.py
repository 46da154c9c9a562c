# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a recording that can be played, opened for publishing."""

from collections.abc import Callable
from collections.abc import Iterable
from importlib import import_module
import re
import sys
import time
from typing import Any
from typing import Literal

from builtin_interfaces.msg import Time
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.schedule import PlayOptions
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.bag_messages import recorded_type_hash
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.duration import Duration
from rclpy.exceptions import InvalidTopicNameException
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.type_support import check_for_type_support
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import Qos
from rosbags.interfaces import QosDurability
from rosbags.interfaces import QosHistory
from rosbags.interfaces import QosReliability
from rosidl_generator_py.import_type_support_impl import UnsupportedTypeSupport

# Length of the header of a serialised message [bytes]; its second byte gives the byte order.
_ENCAPSULATION = 4
_STAMP = 8
_DEPTH = 10
CLOCK = TOPICS['clock'].name
# Wait for a reader to confirm [s]; Fast DDS asks for it again every 3 s, so one that has all
# messages may seem to lack them for so long. A hung one costs this once.
PATIENCE = 4.0
_SLICE = 0.01


def has_header(message_class: Any) -> bool:
    """Return whether messages of this class begin with a std_msgs/Header."""
    fields = message_class.get_fields_and_field_types()
    return next(iter(fields.items()), None) == ('header', 'std_msgs/Header')


def header_stamp(data: bytes) -> Time:
    """Return the stamp of ``data``, a serialised message that begins with a header."""
    order: Literal['little', 'big'] = 'little' if data[1] & 1 else 'big'
    parts = data[_ENCAPSULATION:_ENCAPSULATION + _STAMP]
    return Time(
        sec=int.from_bytes(parts[:4], order, signed=True),
        nanosec=int.from_bytes(parts[4:], order))


def played_quality(name: str, type_name: str, offered: Iterable[Qos]) -> QoSProfile:
    """
    Return what to offer on the topic ``name``: the best that any of its publishers offered.

    Whoever could read one of them can read that. Deadlines and lifespans are left out: at another
    pace they would be missed.

    :param offered: profiles of the recorded publishers
    """
    offered = list(offered)
    depth = max((profile.depth for profile in offered
                 if profile.history == QosHistory.KEEP_LAST), default=0)
    reliable = not offered or any(
        profile.reliability != QosReliability.BEST_EFFORT for profile in offered)
    kept = any(profile.durability == QosDurability.TRANSIENT_LOCAL for profile in offered)
    return QoSProfile(
        depth=depth or _usual_depth(name, type_name),
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if kept else DurabilityPolicy.VOLATILE)


def _usual_depth(name: str, type_name: str) -> int:
    """Return the depth where none is recorded: a graph does not tell it, so `ros2 bag` can't."""
    return next(
        (topic.depth for key, topic in TOPICS.items()
         if topic.type_name == type_name and name.endswith(f'/{key}')), _DEPTH)


class PlayedTopic:
    """
    Publish serialised messages no faster than reliable readers take them.

    A reliable publisher keeps its last ``depth`` messages until every reader has them, and drops
    the oldest without a word when one more comes. So it is given no more than that at once.

    ``overruns`` counts those that it dropped while a reader had not confirmed them, and
    ``damaged`` those that the middleware refused. What a slow reader drops from its own queue no
    publisher learns.

    :param name: in the graph, with its namespace
    :param kept: how many of its messages still hold for those who come late
    :param patience: timeout for a reader to acknowledge its messages [s]
    """

    def __init__(
            self, node: Node, name: str, message_class: type, quality: QoSProfile,
            kept: int = 0, patience: float = PATIENCE) -> None:
        """Make the publisher."""
        self.name = name
        self.message_class = message_class
        self.kept = kept
        self.overruns = 0
        self.damaged = 0
        self._publisher = node.create_publisher(message_class, name, quality)
        self._is_reliable = quality.reliability == ReliabilityPolicy.RELIABLE
        self._depth = quality.depth
        self._patience = patience
        self._waiting = 0
        self._is_stuck = False

    def publish(self, data: bytes) -> bool:
        """Publish ``data``, a serialised message; return whether the middleware took it."""
        if self._is_reliable and self._waiting >= self._depth:
            # A reader that has hung is waited for once, and then no more until it is back.
            if self.settle(0.0 if self._is_stuck else self._patience):
                self._is_stuck = False
            else:
                self._is_stuck = True
                self.overruns += 1
        try:
            self._publisher.publish(data)
        except rclpy_implementation.RCLError:
            self.damaged += 1
            return False
        self._waiting += 1
        return True

    def settle(self, patience: float) -> bool:
        """Wait up to ``patience`` [s] for all readers; return whether they have all messages."""
        deadline = time.monotonic() + patience
        done = self._is_taken(0.0)
        while not done and time.monotonic() < deadline:
            done = self._is_taken(_SLICE)
        if done:
            self._waiting = 0
        return done

    def _is_taken(self, patience: float) -> bool:
        """Wait up to ``patience`` [s], which no other thread of Python runs in."""
        return self._publisher.get_subscription_count() == 0 or (
            self._publisher.wait_for_all_acked(Duration(seconds=patience)))


_TYPE_NAME = re.compile(r'([a-z][a-z0-9_]*)/msg/([A-Z][A-Za-z0-9]*)')
_PARAMETERS = TOPICS['inputs/parameters']


def message_class(type_name: str, definition: MessageDefinition) -> type:
    """
    Return the class of ``type_name``, such as std_msgs/msg/Header.

    :param definition: of the recorded messages, as far as the bag holds it
    :raises ClothSimError: when it is not installed, or not as it was when recorded
    """
    match = _TYPE_NAME.fullmatch(type_name)
    if match is None:
        raise ClothSimError(
            f'{shown(type_name)} is not a message type: record it again, with a type like '
            'std_msgs/msg/Header')
    package, name = match.groups()
    try:
        found = getattr(import_module(f'{package}.msg'), name)
        check_for_type_support(found)
    except (ImportError, AttributeError, UnsupportedTypeSupport) as error:
        raise ClothSimError(
            f'the message type {type_name} is not installed: install or build the package '
            f'{package}, and source its setup') from error
    if not _is_as_installed(type_name, definition):
        raise ClothSimError(
            f'the message type {type_name} had another definition when this was recorded: play it '
            f'with the {package} of that time')
    return found


def _is_as_installed(type_name: str, definition: MessageDefinition) -> bool:
    recorded = recorded_type_hash(type_name, definition)
    try:
        return recorded in ('', type_hash(type_name))
    except (ClothSimError, OSError):
        return True  # an installed package without its files can't tell


# Each node has a publisher of these, this one too, and nobody takes them for a cloth's.
_OF_EVERY_NODE = frozenset({'/parameter_events', '/rosout'})


def other_publishers(node: Node, topics: Iterable[str]) -> dict[str, list[str]]:
    """Return the topics that other nodes publish, by the full names of those nodes."""
    own = _full_name(node.get_namespace(), node.get_name())
    found: dict[str, list[str]] = {}
    for topic in topics:
        if topic in _OF_EVERY_NODE:
            continue
        names = [
            _full_name(publisher.node_namespace, publisher.node_name)
            for publisher in node.get_publishers_info_by_topic(topic)]
        if own in names:
            # One of them is this node itself; a second one of its name is another player.
            names.remove(own)
        for name in names:
            found.setdefault(name, []).append(topic)
    return found


def warning_of(others: dict[str, list[str]]) -> str:
    """Return a warning about ``others``; empty when there are none."""
    if not others:
        return ''
    name, topics = max(others.items(), key=lambda item: len(item[1]))
    more = f' and {len(topics) - 1} more of these topics' if len(topics) > 1 else ''
    return (
        f'{name} publishes {topics[0]}{more} as well, and subscribers receive both: stop it, or '
        'rename the played topics with --as')


def _full_name(namespace: str, name: str) -> str:
    return f'{namespace.rstrip("/")}/{name}'


def wanted_topics(topics: Iterable[BagTopic], options: PlayOptions) -> list[BagTopic]:
    """Return those of ``topics`` that are to be played; ClothSimError when one is not there."""
    topics = list(topics)
    names = {topic.name for topic in topics}
    if CLOCK in options.topics and not options.clock:
        raise ClothSimError(
            f'--topics has {CLOCK}, which moves the time of every node with use_sim_time: add '
            '--clock to have it played')
    for name in options.topics:
        if name not in names:
            raise ClothSimError(
                f'the recording has no topic {cut(name)}: choose from {", ".join(sorted(names))}')
    return [
        topic for topic in topics
        if (not options.topics or topic.name in options.topics)
        and (options.clock or topic.name != CLOCK)]


def open_topics(
        node: Node, topics: Iterable[BagTopic], options: PlayOptions,
        warn: Callable[[str], None]) -> dict[tuple[str, str], PlayedTopic]:
    """
    Return the publishers of ``topics``, each by its recorded name and type.

    Topics that cannot be played are left out.

    :param warn: called with a sentence for each topic left out
    :raises ClothSimError: when none is left
    """
    opened: dict[tuple[str, str], PlayedTopic] = {}
    for topic in topics:
        try:
            opened[topic.name, topic.type_name] = _open(node, topic, options)
        except ClothSimError as error:
            warn(f'{cut(topic.name)} is left out: {cut(error)}')
    if not opened:
        raise ClothSimError(
            'the recording has no topic that can be played: give one with messages of types '
            'that are installed')
    return opened


def _open(node: Node, topic: BagTopic, options: PlayOptions) -> PlayedTopic:
    found = message_class(topic.type_name, topic.definition)
    name = options.played_name(topic.name)
    quality = played_quality(topic.name, topic.type_name, topic.qos)
    try:
        return PlayedTopic(node, name, found, quality, _kept(topic, quality))
    except InvalidTopicNameException as error:
        raise ClothSimError(
            f'{cut(name)} is not a valid topic name: rename it with --as') from error


def _kept(topic: BagTopic, quality: QoSProfile) -> int:
    """Return how many messages from before a late start are to be sent all the same."""
    # Each message has some parameters only; a late reader needs them all.
    if topic.name.endswith(f'/{_PARAMETERS.key}') and topic.type_name == _PARAMETERS.type_name:
        return sys.maxsize
    return quality.depth if quality.durability == DurabilityPolicy.TRANSIENT_LOCAL else 0
