# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours, sizes and light of all pictures."""

from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import View
import numpy as np

BACKGROUND = (1.0, 1.0, 1.0)
GRID_COLOR = (0.80, 0.80, 0.80)
SHADOW_COLOR = (0.91, 0.91, 0.915)
PIN_COLOR = (0.84, 0.10, 0.12)
PUSH_COLOR = (0.08, 0.38, 0.88)
LIMIT_COLOR = (0.16, 0.86, 0.84)    # stands out from strained and from slack cloth
UNKNOWN_COLOR = (0.72, 0.76, 0.82)  # of a cloth whose strain is not known

COLLIDER_COLOR = (0.70, 0.68, 0.65)  # as quiet as the floor, and darker
GROUND_COLOR = (0.955, 0.95, 0.94)

HEM_SHADE = 0.45      # how much darker the border of a cloth is
HIDDEN = 0.22         # opacity of a pin or an arrow behind the cloth
GRID_LINES = 8        # across the longest side


# Right, up and towards the camera.
DIRECTION = np.array([-0.45, 0.50, 0.74]) / np.linalg.norm([-0.45, 0.50, 0.74])
AMBIENT = 0.28
WRAP_POWER = 1.4      # of the light that reaches around the cloth: 1 to 2
GLOSS = 0.10
GLOSS_POWER = 24.0
BACK = 0.88

LIGHT_DEFINES = {
    'AMBIENT': AMBIENT, 'WRAP_POWER': WRAP_POWER, 'GLOSS': GLOSS, 'GLOSS_POWER': GLOSS_POWER,
    'BACK': BACK}


def set_light(program: RenderProgram, view: View) -> None:
    """Give the lamp's direction in the scene to ``program``, which is in use."""
    halfway = DIRECTION + np.array([0.0, 0.0, 1.0])
    program.set_vectors('light', DIRECTION @ view.axes)
    program.set_vectors('halfway', halfway / np.linalg.norm(halfway) @ view.axes)
