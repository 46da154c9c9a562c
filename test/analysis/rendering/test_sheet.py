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


"""The panels of a picture and their common view."""

from cloth_sim_ros.analysis.camera import Camera
from cloth_sim_ros.analysis.sheet import Sheet
from cloth_sim_ros.sim.push import Push
import numpy as np
import pytest


def test_nothing_is_cut_off(hanging):
    """A part of the cloth, or a push, would lie outside its panel."""
    push = Push.checked(force=(0.0, -5.0, 9.0), start=0.0, duration=10.0)
    swung = hanging(2.0, pushes=(push,))
    swung.records['y'] = 1.5 * swung.records['z']
    frames = [hanging(1.0), swung]
    camera = Camera()
    sheet = Sheet(frames, camera)
    for axes, frame in zip(sheet.panels, frames):
        sheet.set_up(axes, frame.time)
        drawn = np.concatenate(
            [frame.positions.reshape(-1, 3), *frame.push_arrows(sheet.arrow_length)])
        seen = camera.project(drawn)
        for values, (low, high) in ((seen[:, 0], axes.get_xlim()), (seen[:, 1], axes.get_ylim())):
            assert low < values.min() and values.max() < high


def test_all_panels_are_seen_alike(hanging):
    """Panels could not be compared: each would have its own scale."""
    small = hanging(0.0)
    small.records['x'] *= 0.1
    sheet = Sheet([small, hanging(1.0), hanging(2.0), hanging(3.0)], Camera())
    for axes, time in zip(sheet.panels, range(4)):
        sheet.set_up(axes, time)
        assert axes.get_aspect() == 1.0
    assert len({axes.get_xlim() for axes in sheet.panels}) == 1
    assert len({axes.get_ylim() for axes in sheet.panels}) == 1


def test_each_panel_says_its_time(hanging):
    """A reader would not know which moment is shown."""
    sheet = Sheet([hanging(0.0), hanging(1.25)], Camera())
    for axes, time in zip(sheet.panels, (0.0, 1.25)):
        sheet.set_up(axes, time)
    assert [axes.get_title() for axes in sheet.panels] == ['t = 0.00 s', 't = 1.25 s']


@pytest.mark.parametrize('rows, cols', [(20, 1), (1, 20), (2, 2)])
def test_a_chain_has_a_panel_one_can_see(hanging, rows, cols):
    """The picture of a chain would be a metre high and a finger wide."""
    frame = hanging(rows=rows, cols=cols)
    if cols == 1:
        frame.records['x'] = 0.0
    sheet = Sheet([frame], Camera())
    sheet.set_up(sheet.panels[0], 0.0)
    (left, right), (bottom, top) = sheet.panels[0].get_xlim(), sheet.panels[0].get_ylim()
    assert 0.4 < (right - left) / (top - bottom) < 2.5
