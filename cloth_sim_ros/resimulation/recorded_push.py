# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A push as a recording holds it."""

from typing import Any

from cloth_sim_ros.sim.push import Push


def recorded_push(message: Any) -> Push:
    """Return the push of a decoded Push message of ~/inputs/push; ClothSimError if it is none."""
    return Push.checked(
        force=parts(message.force), start=message.start, duration=message.duration,
        region=message.region, center=parts(message.center), radius=message.radius)


def parts(vector: Any) -> tuple[float, float, float]:
    """Return the components of a decoded Point or Vector3."""
    return (vector.x, vector.y, vector.z)
