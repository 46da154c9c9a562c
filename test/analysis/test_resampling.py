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


"""More or fewer places than nodes."""

from cloth_sim_ros.analysis.resampling import resampled
import numpy as np
import pytest


@pytest.mark.parametrize('rows, cols', [(2, 3), (7, 64), (65, 66), (300, 12), (1, 9)])
def test_a_plane_stays_a_plane(rows, cols):
    """The drawn cloth would lie beside the simulated one."""
    values = np.stack(np.meshgrid(
        np.linspace(0.0, 1.0, rows), np.linspace(0.0, 2.0, cols), indexing='ij'), axis=-1)
    drawn = resampled(values, 65)
    assert max(drawn.shape[:2]) <= 65
    expected = np.stack(np.meshgrid(
        np.linspace(0.0, 1.0, drawn.shape[0]) if rows > 1 else [0.0],
        np.linspace(0.0, 2.0, drawn.shape[1]), indexing='ij'), axis=-1)
    np.testing.assert_allclose(drawn, expected, atol=1e-12)


def test_a_coarse_cloth_keeps_its_nodes():
    """A peak of strain at one node would be cut off."""
    values = np.random.default_rng(3).random((6, 5))
    drawn = resampled(values, 40)
    np.testing.assert_allclose(drawn[::7, ::9], values)
