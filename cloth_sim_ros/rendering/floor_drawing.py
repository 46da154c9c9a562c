# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw a level grid below the cloth, which shows how the view lies."""

from functools import cached_property

from cloth_sim_ros.rendering.look import GRID_COLOR
from cloth_sim_ros.rendering.look import GRID_LINES
from cloth_sim_ros.rendering.strain_scale import round_up
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.rendering.view_uniforms import set_view
from cloth_sim_ros.gl.draw_state import draw_over_all
from cloth_sim_ros.gl.render_program import RenderProgram
import numpy as np

_LINE_WIDTH = 1.0     # [pixel of the picture]
_REACH = 1.6          # of half a side of the grid over the longest side of all cloths


class FloorDrawing:
    """
    Draws the floor below all frames of ``survey``.

    :param detail: drawn pixels along each side of a pixel of the picture
    """

    def __init__(self, survey: Survey, detail: int) -> None:
        """Choose the grid."""
        self.height = survey.floor
        self.step = grid_step(survey.size)
        self._middle = np.append(survey.middle[:2], self.height)
        self._reach = _REACH * max(survey.size, self.step)
        self._detail = detail

    def draw(self, view: View) -> None:
        """Draw it over all before, and behind all that comes."""
        program = self._program
        program.use()
        set_view(program, view)
        program.set_vectors('middle', self._middle - view.middle)
        program.set_float('reach', self._reach)
        program.set_float('grid_step', self.step)
        program.set_pair('grid_offset', tuple(np.remainder(self._middle[:2], self.step)))
        program.set_float('line_width', _LINE_WIDTH * self._detail)
        program.set_vectors('line_color', GRID_COLOR)
        draw_over_all()
        program.draw_strips(4)

    @cached_property
    def _program(self) -> RenderProgram:
        return RenderProgram('render/floor.vert', 'render/floor.frag')


def grid_step(size: float) -> float:
    """Return the distance of the grid's lines [m] for cloths of ``size`` [m]."""
    return round_up(max(size, 1e-6) / GRID_LINES)
