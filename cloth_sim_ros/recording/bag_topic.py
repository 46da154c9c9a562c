# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A topic of a bag, and one of its messages as they were recorded."""

from dataclasses import dataclass
from typing import NamedTuple

from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import Qos


@dataclass(frozen=True)
class BagTopic:
    """
    A topic of a bag.

    :param type_name: such as std_msgs/msg/Header
    :param qos: what its publishers offered; empty where the bag does not say
    :param count: of its messages; of a broken file, of those that can be read
    :param definition: of the type, as far as the bag holds it
    """

    name: str
    type_name: str
    qos: tuple[Qos, ...]
    count: int
    definition: MessageDefinition


class RawMessage(NamedTuple):
    """
    A message as it was recorded.

    :param topic: its full name
    :param time: at which it was recorded: simulated in this project's recordings, of the wall
        clock in those of `ros2 bag record` [ns]
    :param data: CDR, with its header of 4 bytes
    """

    topic: str
    type_name: str
    time: int
    data: bytes
