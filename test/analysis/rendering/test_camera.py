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


"""How the camera sees the scene."""

from cloth_sim_ros.analysis.camera import Camera
from hypothesis import given
from hypothesis import strategies
import numpy as np
import pytest

ANGLES = strategies.tuples(
    strategies.floats(-360.0, 360.0), strategies.floats(-90.0, 90.0))


@given(ANGLES)
def test_it_neither_stretches_nor_mirrors(angles):
    """A square cloth would look like a rectangle, or like its mirror image."""
    axes = Camera(*angles).axes
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


@given(strategies.floats(-360.0, 360.0), strategies.floats(-89.0, 89.0))
def test_z_is_up_in_the_view(azimuth, elevation):
    """The cloth would hang sideways or upwards."""
    right, up, _ = Camera(azimuth, elevation).project(np.array([0.0, 0.0, 1.0]))
    assert right == pytest.approx(0.0, abs=1e-12)
    assert up > 0.0


def test_it_stands_where_it_is_told():
    """Near and far would be swapped, and the back of the cloth drawn over its front."""
    near = Camera(90.0, 0.0).project(np.array([0.0, 1.0, 0.0]))
    np.testing.assert_allclose(near, [0.0, 0.0, 1.0], atol=1e-12)
    above = Camera(0.0, 90.0).project(np.array([0.0, 0.0, 1.0]))
    np.testing.assert_allclose(above, [0.0, 0.0, 1.0], atol=1e-12)
    # Seen along y from in front of the cloth, x goes to the right.
    assert Camera(-90.0, 0.0).project(np.array([1.0, 0.0, 0.0]))[0] == pytest.approx(1.0)
