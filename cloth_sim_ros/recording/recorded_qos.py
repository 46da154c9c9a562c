# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The qualities of service that a bag notes of the publishers of a topic."""

from typing import Any

from cloth_sim_ros.files.checked_yaml import parse_yaml
from rosbags.interfaces import Qos
from rosbags.rosbag2.metadata import parse_qos

_MOST_DEPTH = 1_000_000
_MOST_PROFILES = 1000


def recorded_qos(text: object) -> tuple[Qos, ...]:
    """Return the profiles in the YAML ``text``; none where it is no text, or of another form."""
    if not text or not isinstance(text, str):
        return ()
    try:
        profiles = tuple(parse_qos(parse_yaml(text, 'offered_qos_profiles')[:_MOST_PROFILES]))
    except Exception:  # of another writer, in another form: nothing is read by it
        return ()
    are_right = all(
        type(profile.depth) is int and 0 <= profile.depth <= _MOST_DEPTH for profile in profiles)
    return profiles if are_right else ()


def qos_profiles(text: object) -> list[dict[str, Any]]:
    """Return the profiles in the YAML ``text`` as metadata.yaml of version 9 has them."""
    return [{
        'history': profile.history.name.lower(),
        'depth': profile.depth,
        'reliability': profile.reliability.name.lower(),
        'durability': profile.durability.name.lower(),
        'deadline': profile.deadline._asdict(),
        'lifespan': profile.lifespan._asdict(),
        'liveliness': profile.liveliness.name.lower(),
        'liveliness_lease_duration': profile.liveliness_lease_duration._asdict(),
        'avoid_ros_namespace_conventions': profile.avoid_ros_namespace_conventions,
    } for profile in recorded_qos(text)]
