# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw lines of one width in the picture: a chain, and rings around pushed regions."""

from functools import cached_property

from cloth_sim_ros.rendering.look import HEM_SHADE
from cloth_sim_ros.rendering.look import UNKNOWN_COLOR
from cloth_sim_ros.rendering.palette_buffer import PALETTE_DEFINES
from cloth_sim_ros.rendering.palette_buffer import PaletteBuffer
from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.rendering.view_uniforms import set_view
from cloth_sim_ros.gl.render_program import RenderProgram

RIBBON_DEFINES = {**PALETTE_DEFINES, 'HEM_SHADE': HEM_SHADE}


class RibbonDrawing:
    """
    Draws the line through the points in the node buffer, coloured by strain.

    :param detail: drawn pixels along each side of a pixel of the picture
    """

    def __init__(self, palette: PaletteBuffer, detail: int) -> None:
        """Keep what all lines share."""
        self._palette = palette
        self._detail = detail

    def draw(
            self, count: int, view: View, width: float, *, rim: float = 0.0,
            opacity: float = 1.0, color: tuple[float, float, float] = UNKNOWN_COLOR) -> None:
        """
        Draw the first ``count`` points' line.

        :param width: [pixel of the picture]
        :param rim: of its darker border, on each side [pixel of the picture]
        :param color: of points without strain
        """
        program = self._program
        program.use()
        set_view(program, view, self._detail)
        self._palette.give(program, color)
        program.set_float('half_width', 0.5 * width * self._detail)
        program.set_float('rim', rim * self._detail)
        program.set_float('opacity', opacity)
        program.draw_strips(4, count - 1)

    @cached_property
    def _program(self) -> RenderProgram:
        return RenderProgram('render/ribbon.vert', 'render/ribbon.frag', RIBBON_DEFINES)
