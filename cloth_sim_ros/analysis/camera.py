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


"""A camera without perspective: lengths across the view are the same near and far."""

from dataclasses import dataclass
import math

import numpy as np


@dataclass(frozen=True)
class Camera:
    """
    Looks at the scene from far away, with z up.

    :param azimuth: direction it stands in, counted from x towards y [deg]
    :param elevation: how far above the horizon it stands [deg]
    """

    azimuth: float = -55.0
    elevation: float = 22.0

    @property
    def axes(self) -> np.ndarray:
        """Right, up and towards the camera, as the rows of a rotation."""
        azimuth, elevation = math.radians(self.azimuth), math.radians(self.elevation)
        right = (-math.sin(azimuth), math.cos(azimuth), 0.0)
        towards = (
            math.cos(azimuth) * math.cos(elevation), math.sin(azimuth) * math.cos(elevation),
            math.sin(elevation))
        return np.array([right, np.cross(towards, right), towards])

    def project(self, points: np.ndarray) -> np.ndarray:
        """Return right, up and nearness [m] of ``points``, (..., 3) each."""
        return points @ self.axes.T
