# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A topic's quality of service as rosbag2 writes it."""

from typing import Any

from cloth_sim_ros.messages.topics import Topic

_FOR_EVER = (9223372036, 854775807)  # RMW_DURATION_INFINITE


def offered_qos(topic: Topic) -> list[dict[str, Any]]:
    """Return the profile of the one publisher of ``topic``."""
    return [{
        'history': 'keep_last',
        'depth': topic.depth,
        'reliability': 'reliable' if topic.reliable else 'best_effort',
        'durability': 'transient_local' if topic.transient_local else 'volatile',
        'deadline': _for_ever(),
        'lifespan': _for_ever(),
        'liveliness': 'automatic',
        'liveliness_lease_duration': _for_ever(),
        'avoid_ros_namespace_conventions': False,
    }]


def _for_ever() -> dict[str, int]:
    # A new one each time: YAML would write references to a shared one.
    return {'sec': _FOR_EVER[0], 'nsec': _FOR_EVER[1]}
