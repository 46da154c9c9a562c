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


"""The picture as a file."""

from cloth_sim_ros.analysis.picture import write_picture
from cloth_sim_ros.sim.errors import ClothSimError
from matplotlib.image import imread
import numpy as np
import pytest


def test_each_panel_shows_the_cloth_on_white(tmp_path, hanging):
    """A panel would be empty, black, or filled from edge to edge."""
    file = tmp_path / 'cloth.png'
    write_picture([hanging(0.0), hanging(1.0), hanging(2.0)], file, title='three', note='note')
    picture = imread(file)[..., :3]
    height, width = picture.shape[:2]
    assert width > 800 and 200 < height < width
    is_cloth = (np.abs(picture - 1.0) > 0.1).any(axis=-1)
    for panel in range(3):
        # The three panels share the width that the colour bar leaves.
        left, right = (int((0.01 + 0.29 * edge) * width) for edge in (panel, panel + 1))
        assert 0.1 < is_cloth[int(0.15 * height):int(0.85 * height), left:right].mean() < 0.9
    assert np.all(picture[0] == 1.0) and np.all(picture[:, 0] == 1.0)


def test_a_file_that_cannot_be_written_is_told(tmp_path, hanging):
    """A user would get a traceback for a mistyped folder."""
    with pytest.raises(ClothSimError, match='nowhere.*cannot be written'):
        write_picture([hanging()], tmp_path / 'nowhere' / 'cloth.png')
