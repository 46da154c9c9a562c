# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
