# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Who else publishes the topics that are to be played."""

from collections.abc import Iterable

from rclpy.node import Node


def other_publishers(node: Node, topics: Iterable[str]) -> dict[str, list[str]]:
    """Return the topics that other nodes publish, by the full names of those nodes."""
    own = _full_name(node.get_namespace(), node.get_name())
    found: dict[str, list[str]] = {}
    for topic in topics:
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
    """Return what to tell about ``others``; empty when there are none."""
    if not others:
        return ''
    name, topics = max(others.items(), key=lambda item: len(item[1]))
    more = f' and {len(topics) - 1} more of these topics' if len(topics) > 1 else ''
    return (
        f'{name} publishes {topics[0]}{more} as well, and subscribers receive both: stop it, or '
        'rename the played topics with --as')


def _full_name(namespace: str, name: str) -> str:
    return f'{namespace.rstrip("/")}/{name}'
