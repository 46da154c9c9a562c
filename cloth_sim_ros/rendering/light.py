# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The lamp of all pictures: over the left shoulder of the camera."""

from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.gl.render_program import RenderProgram
import numpy as np

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
