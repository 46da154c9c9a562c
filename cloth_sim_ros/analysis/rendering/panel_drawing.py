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

"""The image of a panel: the cloth, and the words in it."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.rendering.push_words import write_forces
from cloth_sim_ros.analysis.rendering.renderer import Renderer
from cloth_sim_ros.analysis.rendering.survey import Survey
import numpy as np


def draw_panel(renderer: Renderer, survey: Survey, frame: Frame, font: int) -> np.ndarray:
    """
    Return the image of ``frame``, (height, width, 3) uint8.

    :param font: height of the letters [pixel]
    """
    image = renderer.draw(frame)
    write_forces(
        image, frame.acting_pushes, survey.arrows(frame), renderer.view, font)
    return image
