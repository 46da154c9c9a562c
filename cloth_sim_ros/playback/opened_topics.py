# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a recording that can be played, opened for publishing."""

from collections.abc import Callable
from collections.abc import Iterable
import sys

from cloth_sim_ros.files.echo import cut
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.playback.message_class import message_class
from cloth_sim_ros.playback.play_options import PlayOptions
from cloth_sim_ros.playback.played_quality import played_quality
from cloth_sim_ros.playback.played_topic import PlayedTopic
from cloth_sim_ros.recording.bag_topic import BagTopic
from cloth_sim_ros.sim.errors import ClothSimError
from rclpy.exceptions import InvalidTopicNameException
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile

_PARAMETERS = TOPICS['inputs/parameters']


def wanted_topics(topics: Iterable[BagTopic], options: PlayOptions) -> list[BagTopic]:
    """Return those of ``topics`` that are to be played; ClothSimError when one is not there."""
    topics = list(topics)
    names = {topic.name for topic in topics}
    for name in options.topics:
        if name not in names:
            raise ClothSimError(
                f'the recording has no topic {cut(name)}: choose from {", ".join(sorted(names))}')
    return [topic for topic in topics if not options.topics or topic.name in options.topics]


def open_topics(
        node: Node, topics: Iterable[BagTopic], options: PlayOptions,
        warn: Callable[[str], None]) -> dict[tuple[str, str], PlayedTopic]:
    """
    Return the publishers of ``topics``, each by its recorded name and type.

    What can't be played is left out.

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
    # Each tells of some parameters only: all of them together hold.
    if topic.name.endswith(f'/{_PARAMETERS.key}') and topic.type_name == _PARAMETERS.type_name:
        return sys.maxsize
    return quality.depth if quality.durability == DurabilityPolicy.TRANSIENT_LOCAL else 0
