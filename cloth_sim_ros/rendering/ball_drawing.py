# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw balls on nodes: on those that are held, and on those of a chain at their limit."""

from functools import cached_property
import math

from cloth_sim_ros.rendering.seen_and_hidden import seen_and_hidden
from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.rendering.view_uniforms import set_view
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.render_program import RenderProgram
import numpy as np

_UNIT = 0             # render/ball.vert
_RADIUS = 1.0 / 75.0  # of the shorter side of the picture
_SMALLEST = 1.2       # [pixel]
_SHARE = 0.36         # of the distance between neighbouring balls
_LEAD = 4.0           # in front of the cloth, over the radius: a ball should not be cut by it

BALL_DEFINES = {'RIM': 1.3}


class BallDrawing:
    """
    Draws balls that all look alike, smaller where they stand close together.

    :param detail: drawn pixels along each side of a pixel of the picture
    """

    def __init__(self, detail: int) -> None:
        """Keep what all frames share."""
        self._detail = detail

    def draw(
            self, points: np.ndarray, view: View, color: tuple[float, float, float],
            size: float = 1.0) -> None:
        """
        Draw a ball at each of ``points``, (n, 3) [m]; faintly where the cloth hides it.

        :param size: over that of a pin
        """
        if not len(points):
            return
        radius = size * ball_radius(view.project(points), view)
        places = np.zeros((len(points), 4), np.float32)
        places[:, :3] = points - view.middle
        buffer = Buffer(places)
        buffer.bind_texture(_UNIT)
        program = self._program
        program.use()
        set_view(program, view, self._detail)
        program.set_float('radius', radius * self._detail)
        program.set_float('lead', _LEAD * radius * view.pixel)
        program.set_vectors('ball_color', color)
        for opacity in seen_and_hidden():
            program.set_float('opacity', opacity)
            program.draw_strips(4, len(points))
        buffer.delete()

    @cached_property
    def _program(self) -> RenderProgram:
        return RenderProgram('render/ball.vert', 'render/ball.frag', BALL_DEFINES)


def ball_radius(seen: np.ndarray, view: View) -> float:
    """Return the radius of a ball [pixel] at each of ``seen``, (n, 2) [pixel]."""
    largest = _RADIUS * min(view.width, view.height)
    if len(seen) < 3:
        return largest
    # Nodes follow each other along the rows: the next one in their order is a near one.
    steps = np.linalg.norm(np.diff(seen, axis=0), axis=1)
    near = float(np.percentile(steps, 25))
    return max(min(largest, _SHARE * near), _SMALLEST) if math.isfinite(near) else largest
