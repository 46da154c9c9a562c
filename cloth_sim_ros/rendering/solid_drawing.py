# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw what is not cloth: floor, ribbons, balls at pins, arrows of pushes, and colliders."""

from collections.abc import Iterable
from collections.abc import Iterator
from functools import cached_property
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.framebuffer import draw_clockwise_only
from cloth_sim_ros.gl.framebuffer import draw_hidden
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.framebuffer import draw_over_all
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import set_view
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.cloth_drawing import ClothDrawing
from cloth_sim_ros.rendering.cloth_drawing import PALETTE_DEFINES
from cloth_sim_ros.rendering.cloth_drawing import PaletteBuffer
from cloth_sim_ros.rendering.look import COLLIDER_COLOR
from cloth_sim_ros.rendering.look import GRID_COLOR
from cloth_sim_ros.rendering.look import GRID_LINES
from cloth_sim_ros.rendering.look import GROUND_COLOR
from cloth_sim_ros.rendering.look import HEM_SHADE
from cloth_sim_ros.rendering.look import HIDDEN
from cloth_sim_ros.rendering.look import LIGHT_DEFINES
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.look import round_up
from cloth_sim_ros.rendering.look import set_light
from cloth_sim_ros.rendering.look import UNKNOWN_COLOR
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.model.collider_surface import collider_surface
from cloth_sim_ros.sim.model.collider_surface import is_ground
from cloth_sim_ros.sim.model.colliders import Collider
import numpy as np

# The floor.
_LINE_WIDTH = 1.0     # [pixel of the picture]
_REACH = 1.6          # of half a side of the grid over the longest side of all cloths
RIBBON_DEFINES = {**PALETTE_DEFINES, 'HEM_SHADE': HEM_SHADE}
# Balls.
_UNIT = 0             # render/ball.vert
_RADIUS = 1.0 / 75.0  # of the shorter side of the picture
_SMALLEST = 1.2       # [pixel]
_SHARE = 0.36         # of the distance between neighbouring balls
_LEAD = 4.0           # in front of the cloth, over the radius: a ball should not be cut by it
BALL_DEFINES = {'RIM': 1.3}
# Arrows.
_SIDES = 40
_SHAFT = 0.016        # radius over the length of the largest arrow
_HEAD = 0.048
_HEAD_LENGTH = 0.17
ARROW_DEFINES = {**LIGHT_DEFINES, 'SIDES': _SIDES}


def seen_and_hidden(*, hides: bool = False) -> Iterator[float]:
    """
    Yield the opacity to draw with, once for what is hidden and once for what is seen.

    :param hides: hide what comes later and is farther away
    """
    draw_hidden()
    yield HIDDEN
    draw_nearest(hides=hides)
    yield 1.0
    draw_nearest()


class FloorDrawing:
    """
    Draws the floor below all frames of ``survey``.

    :param detail: drawn pixels along each side of a pixel of the picture
    """

    def __init__(self, survey: Survey, detail: int) -> None:
        """Choose the grid."""
        self.step = grid_step(survey.size)
        self._middle = survey.middle[:2]
        self._reach = _REACH * max(survey.size, self.step)
        self._detail = detail

    def draw_ground(self, view: View, height: float) -> None:
        """Draw a plane at ``height`` [m], which hides what is below."""
        program = self._ground
        self._place(program, view, height)
        program.set_vectors('ground_color', GROUND_COLOR)
        draw_nearest()
        program.draw_strips(4)

    def draw(self, view: View, height: float) -> None:
        """Draw the grid at ``height`` [m] over all before, and behind all that comes."""
        program = self._program
        self._place(program, view, height)
        program.set_float('grid_step', self.step)
        program.set_pair('grid_offset', tuple(np.remainder(self._middle, self.step)))
        program.set_float('line_width', _LINE_WIDTH * self._detail)
        program.set_vectors('line_color', GRID_COLOR)
        draw_over_all()
        program.draw_strips(4)

    def _place(self, program: RenderProgram, view: View, height: float) -> None:
        program.use()
        set_view(program, view)
        program.set_vectors('middle', np.append(self._middle, height) - view.middle)
        program.set_float('reach', self._reach)

    @cached_property
    def _program(self) -> RenderProgram:
        return RenderProgram('render/floor.vert', 'render/floor.frag')

    @cached_property
    def _ground(self) -> RenderProgram:
        return RenderProgram('render/floor.vert', 'render/ground.frag')


def grid_step(size: float) -> float:
    """Return the distance of the grid's lines [m] for cloths of ``size`` [m]."""
    return round_up(max(size, 1e-6) / GRID_LINES)


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


# Draw what the cloth can touch.

# Cloth that touches is drawn in front, though it is drawn without its thickness and its faces
# dip into bodies between the nodes; over the longest side of all cloths.
_BEHIND = 1e-3
_PLANE = 0.9          # half the side of a plane that is not level, over that side


class ColliderDrawing:
    """
    Draws bodies, and planes that are not level; level ones are the floor.

    :param cloth: that draws the shadows
    :param nodes: to write surfaces into
    """

    def __init__(self, cloth: ClothDrawing, nodes: NodeBuffer, survey: Survey) -> None:
        """Keep what all frames share."""
        self._cloth = cloth
        self._nodes = nodes
        self._survey = survey

    def draw_shadows(self, colliders: Iterable[Collider], view: View, floor: float) -> None:
        """Draw the shadows of bodies on the floor at the height ``floor`` [m], over all before."""
        for collider in colliders:
            if collider.shape != 'plane':
                points, normals = collider_surface(collider)
                self._nodes.load_surface(points, normals, view.middle)
                self._cloth.draw_shadow_of(points.shape[:2], view, floor)

    def draw(self, colliders: Iterable[Collider], view: View) -> None:
        """Draw them where they are; nothing hides them yet but what is drawn."""
        size, middle = self._survey.size, self._survey.middle
        program = self._program
        program.use()
        set_view(program, view)
        set_light(program, view)
        program.set_float('behind', _BEHIND * size)
        program.set_vectors('arrow_color', COLLIDER_COLOR)
        program.set_float('opacity', 1.0)
        for collider in colliders:
            if view.sees(collider) and not is_ground(collider):
                points, normals = collider_surface(collider, middle, _PLANE * size)
                self._nodes.load_surface(points, normals, view.middle)
                rows, cols = points.shape[:2]
                program.set_int('cols', cols)
                program.draw_strips(2 * cols, rows - 1)

    @cached_property
    def _program(self) -> RenderProgram:
        return RenderProgram('render/collider.vert', 'render/arrow.frag', LIGHT_DEFINES)
