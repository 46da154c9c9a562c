# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A topic of this project as it stands in its recordings."""

from cloth_sim_ros.messages.topics import Topic
from cloth_sim_ros.recording.bag_channel import BagChannel
from cloth_sim_ros.recording.bag_metadata import yaml_text
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.offered_qos import offered_qos


def topic_channel(topic: Topic, node_name: str) -> BagChannel:
    """
    Return ``topic`` of the node ``node_name``, which has its namespace.

    :raises ClothSimError: when the package of its type is missing
    :raises OSError: when the definition can't be read
    """
    qos = offered_qos(topic)
    announced = type_hash(topic.type_name)
    return BagChannel(
        topic.full_name(node_name), topic.type_name, 'ros2msg',
        message_definition(topic.type_name).encode(),
        {'offered_qos_profiles': yaml_text(qos), 'topic_type_hash': announced},
        qos, announced, topic.transient_local)
