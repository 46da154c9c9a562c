# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw an arrow for each push that acts, and a ring around the region it acts on."""

from functools import cached_property

from cloth_sim_ros.rendering.light import LIGHT_DEFINES
from cloth_sim_ros.rendering.light import set_light
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.seen_and_hidden import seen_and_hidden
from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.rendering.view_uniforms import set_view
from cloth_sim_ros.gl.draw_state import draw_clockwise_only
from cloth_sim_ros.gl.render_program import RenderProgram
import numpy as np

_SIDES = 40
_SHAFT = 0.016        # radius over the length of the largest arrow
_HEAD = 0.048
_HEAD_LENGTH = 0.17

ARROW_DEFINES = {**LIGHT_DEFINES, 'SIDES': _SIDES}


class PushDrawing:
    """
    Draws arrows.

    :param length: of the arrow of the largest push [m]
    """

    def __init__(self, length: float) -> None:
        """Keep what all frames share."""
        self._length = length

    def draw(self, arrows: list[np.ndarray], view: View) -> None:
        """Draw ``arrows``, tail and tip [m] each; faintly where the cloth hides them."""
        if not arrows:
            return
        program = self._program
        program.use()
        set_view(program, view)
        set_light(program, view)
        program.set_vectors('arrow_color', PUSH_COLOR)
        program.set_float('shaft', _SHAFT * self._length)
        program.set_float('head', _HEAD * self._length)
        for tail, tip in arrows:
            total = float(np.linalg.norm(tip - tail))
            if total == 0.0:
                continue
            program.set_vectors('tail', tail - view.middle)
            program.set_vectors('tip', tip - view.middle)
            program.set_float('head_length', min(_HEAD_LENGTH * self._length, 0.6 * total))
            self._draw_one(program)

    def _draw_one(self, program: RenderProgram) -> None:
        # Its own far side must not show through its near one.
        draw_clockwise_only(True)
        for opacity in seen_and_hidden(hides=True):
            program.set_float('opacity', opacity)
            program.draw_strips(2 * (_SIDES + 1), 4)
        draw_clockwise_only(False)

    @cached_property
    def _program(self) -> RenderProgram:
        return RenderProgram('render/arrow.vert', 'render/arrow.frag', ARROW_DEFINES)
