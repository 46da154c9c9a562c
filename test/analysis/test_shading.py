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


"""Light on the drawn cloth."""

from cloth_sim_ros.analysis.shading import shade
import numpy as np

GREY = np.array([[0.5, 0.5, 0.5, 1.0]])


def brightness(*normal):
    """Return how bright a grey face with this normal looks."""
    unit = np.array([normal]) / np.linalg.norm(normal)
    return float(shade(GREY, unit)[0, :3].mean())


def test_what_faces_the_light_is_brighter():
    """Folds would look like bumps: the light would seem to come from below."""
    facing, level, away = (
        brightness(-0.45, 0.55, 0.7), brightness(0.0, 0.0, 1.0), brightness(0.6, -0.7, 0.4))
    assert facing > level > away > 0.0


def test_the_back_is_lit_like_the_front_but_darker():
    """The back of the cloth would be black, or not to be told from the front."""
    front, back = brightness(-0.2, 0.3, 0.9), brightness(0.2, -0.3, -0.9)
    assert 0.6 * front < back < front


def test_colors_stay_colors():
    """A glossy place would get a colour that does not exist."""
    random = np.random.default_rng(1)
    normals = random.normal(size=(200, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    shaded = shade(np.ones((200, 4)), normals)
    assert shaded.min() >= 0.0 and shaded.max() <= 1.0
    np.testing.assert_array_equal(shaded[:, 3], 1.0)
