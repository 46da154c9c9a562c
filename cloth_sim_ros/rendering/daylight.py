# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw a frame as one sees it: a fabric on its bodies and floor in daylight, with shadows."""

from collections.abc import Iterator
from collections.abc import Mapping
from contextlib import contextmanager
from functools import cached_property
import math

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.camera.light import DEPTH_UNIT
from cloth_sim_ros.camera.light import LIGHT_DEFINES
from cloth_sim_ros.gl.framebuffer import DepthTexture
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import set_view
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.cloth_drawing import cell_sides
from cloth_sim_ros.rendering.cloth_drawing import HEM_WIDTH
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.rendering.surface_programs import draw_surface
from cloth_sim_ros.rendering.surface_programs import gap_defines
from cloth_sim_ros.rendering.surface_programs import SurfacePrograms
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.model.collider_surface import collider_surface
from cloth_sim_ros.sim.model.collider_surface import is_ground
import numpy as np

# Looks of a cloth: coloured by its strain, or one of the fabrics.
STRAIN = 'strain'
FABRICS = ('fabric', 'twill', 'knit', 'plain', 'checked')
LOOKS = (STRAIN, *FABRICS)

# Colours as a screen has them.
PLAIN_COLOR = (0.45, 0.60, 0.76)
WARP_COLOR = (0.26, 0.43, 0.60)   # chambray: dyed threads along columns, light ones along rows
WEFT_COLOR = (0.58, 0.70, 0.79)
TWILL_COLOR = (0.20, 0.28, 0.44)   # denim: indigo over white
TWILL_WEFT = (0.80, 0.82, 0.84)
KNIT_COLOR = (0.66, 0.40, 0.34)
CHECK_COLOR = (0.76, 0.15, 0.17)
CHECK_GROUND = (0.97, 0.96, 0.93)
BODY_COLOR = (0.66, 0.52, 0.40)   # wood
FLOOR_COLOR = (0.96, 0.955, 0.945)

# Across a cloth along its shorter side: checks of 4 cm on a tablecloth of 0.8 m.
_CHECKS = 20
_THREADS = 128        # coarser than most cloth, so that pictures of 400 pixels show them
_STITCHES = 64
# Right, up and towards the camera: from the side, so that folds shade each other.
_LAMP = np.array([-0.50, 0.76, 0.42]) / np.linalg.norm([-0.50, 0.76, 0.42])
_DEPTH_SIDE = 2048    # [pixel]
_BLUR = 0.008         # radius of a shadow's soft edge, over the longest side of all cloths
_FLOOR_BLUR = 0.06    # the same on the floor, which casts no shadow on itself
_MARGIN = 1.05        # what the lamp sees over what is in view
_FLOOR_REACH = 2.6    # half a side of the floor, over the longest side of all cloths
_PLANE = 0.9          # half the side of a plane that is not level, over that side
# Cloth that touches a body is drawn in front of it, over the longest side of all cloths. Its faces
# dip into the rim of a table between the nodes: at 3e-3 the wood of config/tablecloth.yaml shows
# through in spots, from 6e-3 to 9e-3 it does not.
_BEHIND = 6e-3

DAYLIGHT_DEFINES = {**LIGHT_DEFINES, 'DAYLIGHT': 1, 'HEM_SHADE': 0.25, 'LAMP_TAPS': 24}
CHECKED_DEFINES = {**DAYLIGHT_DEFINES, 'CHECKED': 1}
# Brightness from thread to thread and from band to band, relative; width of a band [thread].
WOVEN_DEFINES = {
    **DAYLIGHT_DEFINES, 'WOVEN': 1, 'WEAVE': 'PLAIN_WEAVE', 'SLUB': 0.16, 'UNEVEN': 0.12,
    'BAND': 2.5}
TWILL_DEFINES = {**WOVEN_DEFINES, 'WEAVE': 'TWILL'}
KNIT_DEFINES = {**WOVEN_DEFINES, 'WEAVE': 'KNIT', 'SLUB': 0.06, 'UNEVEN': 0.06}
# A wide edge of a shadow needs more taps, or it has steps.
FLOOR_DEFINES = {**DAYLIGHT_DEFINES, 'LAMP_TAPS': 128}
_FABRIC_DEFINES: Mapping[str, Mapping[str, object]] = {
    'fabric': WOVEN_DEFINES, 'twill': TWILL_DEFINES, 'knit': KNIT_DEFINES,
    'plain': DAYLIGHT_DEFINES, 'checked': CHECKED_DEFINES}
_COLORS = {
    'fabric': (WARP_COLOR, WEFT_COLOR), 'twill': (TWILL_COLOR, TWILL_WEFT),
    'knit': (KNIT_COLOR, KNIT_COLOR), 'plain': (PLAIN_COLOR, PLAIN_COLOR),
    'checked': (CHECK_COLOR, CHECK_GROUND)}


class DaylightDrawing:
    """
    Draws the cloth of a frame as a fabric, with bodies and floor.

    :param fabric: one of FABRICS
    :param nodes: holds the cloth while it is drawn
    :param bodies: to write the surfaces of bodies into
    :param detail: drawn pixels along each side of a pixel of the picture
    """

    def __init__(
            self, fabric: str, nodes: NodeBuffer, bodies: NodeBuffer, survey: Survey,
            detail: int) -> None:
        """Keep what all frames share."""
        self._defines = _FABRIC_DEFINES[fabric]
        self._color, self._ground = _COLORS[fabric]
        self._threads = _STITCHES if fabric == 'knit' else _THREADS
        self._nodes = nodes
        self._bodies = bodies
        self._survey = survey
        self._detail = detail
        self._programs = SurfacePrograms()

    def cast(self, frame: Frame, view: View) -> None:
        """Draw what the lamp sees, before the picture is begun."""
        lamp = self._lamp_view(view)
        self._depths.begin()
        draw_nearest()
        # It casts a shadow as soon as it is a surface.
        if min(frame.records.shape) > 1:
            gaps = gap_defines(frame)
            program = self._programs.of('render/plain.frag', gaps)
            program.use()
            set_view(program, lamp)
            self._nodes.load(frame, view.middle)
            draw_surface(program, frame.records.shape, has_gaps=bool(gaps))
        program = self._programs.of('render/plain.frag', {})
        program.use()
        set_view(program, lamp)
        for shape in self._each_body(frame, view):
            draw_surface(program, shape)

    def draw(self, frame: Frame, view: View, floor: float) -> None:
        """
        Draw floor, bodies and cloth.

        :param floor: its height [m]
        """
        draw_nearest()
        # From below, it would hide what lies on it.
        if view.is_above(floor):
            with self._in_daylight(self._floor, view, _FLOOR_BLUR) as program:
                program.set_float('reach', _FLOOR_REACH * self._survey.size)
                program.set_vectors(
                    'middle', np.append(self._survey.middle[:2], floor) - view.middle)
                program.set_vectors('floor_color', FLOOR_COLOR)
                program.draw_strips(4)
        with self._in_daylight(self._body, view) as program:
            program.set_float('behind', _BEHIND * self._survey.size)
            program.set_vectors('body_color', BODY_COLOR)
            for shape in self._each_body(frame, view):
                draw_surface(program, shape)
        if min(frame.records.shape) == 1:
            return
        self._nodes.load(frame, view.middle)
        gaps = gap_defines(frame)
        fabric = self._programs.of('render/fabric.frag', {**self._defines, **gaps})
        with self._in_daylight(fabric, view) as program:
            rows, cols = frame.records.shape
            along, down = cell_sides(frame.positions)
            shorter = min((cols - 1) * along, (rows - 1) * down)
            program.set_int('rows', rows)
            for name, count in (('check', _CHECKS), ('thread', self._threads)):
                program.set_pair(name, (shorter / count / along, shorter / count / down))
            program.set_float('hem_width', HEM_WIDTH * self._detail)
            program.set_vectors('ground_color', self._ground)
            program.set_vectors('fabric_color', self._color)
            draw_surface(program, (rows, cols), has_gaps=bool(gaps))

    def _lamp_view(self, view: View) -> View:
        """Return how the lamp sees the scene: from so far away that its rays are parallel."""
        towards = _LAMP @ view.axes
        right = np.cross(view.axes[1], towards)
        right /= np.linalg.norm(right)
        axes = np.stack([right, np.cross(towards, right), towards])
        reach = np.abs((self._survey.points - view.middle) @ axes.T).max(axis=0)
        return View(
            width=_DEPTH_SIDE, height=_DEPTH_SIDE, axes=axes, middle=view.middle,
            distance=math.inf, half_height=_MARGIN * float(max(reach[0], reach[1])),
            depth=_MARGIN * float(reach[2]))

    @contextmanager
    def _in_daylight(
            self, program: RenderProgram, view: View, blur: float = _BLUR,
            ) -> Iterator[RenderProgram]:
        """Use ``program`` with the uniforms of render/lamp.glsl."""
        lamp = self._lamp_view(view)
        blur *= self._survey.size
        program.use()
        set_view(program, view)
        self._depths.bind(DEPTH_UNIT)
        program.set_matrix('lamp_matrix', lamp.matrix)
        program.set_vectors('lamp', lamp.axes[2])
        program.set_float('lamp_blur', blur / (2.0 * lamp.half_height))
        program.set_float('lamp_lift', _BLUR * self._survey.size)
        yield program

    def _each_body(self, frame: Frame, view: View) -> Iterator[tuple[int, int]]:
        """Load one body after the other that is no floor; yield its rows and columns."""
        size, middle = self._survey.size, self._survey.middle
        for collider in frame.colliders:
            if view.sees(collider) and not is_ground(collider):
                points, normals = collider_surface(collider, middle, _PLANE * size)
                self._bodies.load_surface(points, normals, view.middle)
                rows, cols = points.shape[:2]
                yield rows, cols

    @cached_property
    def _depths(self) -> DepthTexture:
        return DepthTexture(_DEPTH_SIDE)

    @cached_property
    def _floor(self) -> RenderProgram:
        return RenderProgram('render/floor.vert', 'render/lit_floor.frag', FLOOR_DEFINES)

    @cached_property
    def _body(self) -> RenderProgram:
        return RenderProgram('render/collider.vert', 'render/body.frag', DAYLIGHT_DEFINES)
