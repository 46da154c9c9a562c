# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The image of a panel: the cloth, and the words in it."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.push_words import write_forces
from cloth_sim_ros.rendering.renderer import Renderer
from cloth_sim_ros.rendering.survey import Survey
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
