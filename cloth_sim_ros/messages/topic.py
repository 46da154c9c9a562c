# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One topic: its name, message type and quality of service."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Topic:
    """
    A topic the simulator publishes or records.

    :param key: its name behind the node's, or behind / when ``is_global``
    :param message: class of its messages
    :param depth: messages kept for slow subscribers
    :param reliable: False for best effort
    :param transient_local: True to keep the last ``depth`` for late subscribers
    :param is_global: True for a name that does not depend on the node
    :param recorded: False for what a recording leaves out
    :param text: one line for people
    """

    key: str
    message: type
    depth: int
    reliable: bool = True
    transient_local: bool = False
    is_global: bool = False
    recorded: bool = True
    text: str = ''

    @property
    def name(self) -> str:
        """Name to publish under: private to the node, or global."""
        return f'/{self.key}' if self.is_global else f'~/{self.key}'

    @property
    def type_name(self) -> str:
        """Name of the message type, such as std_msgs/msg/Header."""
        return f'{self.message.__module__.split(".")[0]}/msg/{self.message.__name__}'

    def full_name(self, node_name: str) -> str:
        """Return the name in the graph, for the node ``node_name``, namespace included."""
        return self.name.replace('~', f'/{node_name.lstrip("/")}')
