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


"""What is drawn into a panel."""

from cloth_sim_ros.analysis.camera import Camera
from cloth_sim_ros.analysis.drawing import draw_cloth
from cloth_sim_ros.analysis.drawing import draw_pins
from cloth_sim_ros.analysis.drawing import draw_pushes
from cloth_sim_ros.analysis.strain_scale import StrainScale
from cloth_sim_ros.sim.push import Push
from matplotlib.figure import Figure
import numpy as np
import pytest

CAMERA = Camera(-90.0, 0.0)  # in front of the hanging cloth: x to the right, z up


@pytest.fixture
def axes():
    """Return empty axes."""
    return Figure().subplots()


def test_the_cloth_is_where_it_is(axes, hanging):
    """The drawn cloth would be shifted, stretched, or lack a part."""
    frame = hanging()
    draw_cloth(axes, frame, CAMERA, StrainScale([frame]))
    corners = np.concatenate([path.vertices for path in axes.collections[0].get_paths()])
    np.testing.assert_allclose(corners.min(axis=0), [-0.5, 0.0], atol=1e-6)
    np.testing.assert_allclose(corners.max(axis=0), [0.5, 1.0], atol=1e-6)
    # Each triangle ends where it began, and has its three corners in between.
    area = sum(
        abs(np.cross(*np.pad(path.vertices[1:3] - path.vertices[0], ((0, 0), (0, 1)))))[2] / 2
        for path in axes.collections[0].get_paths())
    assert area == pytest.approx(1.0)


def test_what_is_near_covers_what_is_far(axes, hanging):
    """The back layer of a folded cloth would be drawn over the front one."""
    frame = hanging(rows=2, cols=2)
    frame.records['y'][1] = -1.0
    frame.records['strain'][0], frame.records['strain'][1] = 0.0, 0.04
    draw_cloth(axes, frame, CAMERA, StrainScale([frame]))
    first, last = axes.collections[0].get_facecolors()[[0, -1]]
    # Strained is red, and the strained edge is the near one.
    assert last[0] / last[2] > first[0] / first[2]


def test_a_chain_is_a_line(axes, hanging):
    """A cloth of one column has no faces, and would not be seen."""
    frame = hanging(rows=10, cols=1)
    draw_cloth(axes, frame, CAMERA, StrainScale([frame]))
    assert len(axes.collections[0].get_segments()) > 8


def test_pins_are_marked(axes, hanging):
    """A reader would not see what holds the cloth."""
    draw_pins(axes, hanging(), CAMERA)
    np.testing.assert_allclose(
        axes.collections[0].get_offsets(), [[-0.5, 1.0], [0.5, 1.0]], atol=1e-6)


def test_pushes_have_an_arrow_and_their_force(axes, hanging):
    """A reader would not see what moves the cloth, nor how strongly."""
    toward = Push.checked(force=(0.0, -3.0, 4.0), start=0.0, duration=9.0)
    draw_pushes(axes, hanging(pushes=(toward,)), CAMERA, 0.5)
    arrow, words = axes.texts
    np.testing.assert_allclose(arrow.xy, [0.0, 0.5 + 0.8 * 0.5], atol=1e-6)
    assert words.get_text() == '5 N'


def test_a_push_towards_the_camera_keeps_its_words(axes, hanging):
    """The words of such a push would have no place in the picture."""
    push = Push.checked(force=(0.0, -3.0, 0.0), start=0.0, duration=9.0)
    draw_pushes(axes, hanging(pushes=(push,)), CAMERA, 0.5)
    assert np.all(np.isfinite(axes.texts[1].get_position()))
