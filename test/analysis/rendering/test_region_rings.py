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

"""Rings around pushed regions."""

from cloth_sim_ros.analysis.rendering.camera import Camera
from cloth_sim_ros.analysis.rendering.region_rings import region_rings
from cloth_sim_ros.sim.push import Push
import numpy as np


def test_the_ring_is_the_outline_of_the_sphere():
    """A reader would see another region than the one that is pushed."""
    axes = Camera(20.0, 40.0).axes
    whole = Push.checked(force=(0.0, 0.0, 1.0), start=0.0, duration=1.0)
    part = Push.checked(
        force=(0.0, 0.0, 1.0), start=0.0, duration=1.0, region='sphere', center=(1.0, 2.0, 3.0),
        radius=0.5)
    ring, = region_rings([whole, part], axes)
    away = ring - part.center
    np.testing.assert_allclose(np.linalg.norm(away, axis=1), 0.5)
    np.testing.assert_allclose(away @ axes[2], 0.0, atol=1e-12)
    np.testing.assert_allclose(ring[0], ring[-1])
