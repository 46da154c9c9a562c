# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw the surface of the cloth."""

import math

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.framebuffer import draw_over_all
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import set_view
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.look import HEM_SHADE
from cloth_sim_ros.rendering.look import LIGHT_DEFINES
from cloth_sim_ros.rendering.look import LIMIT_COLOR
from cloth_sim_ros.rendering.look import PALETTE_SIZE
from cloth_sim_ros.rendering.look import set_light
from cloth_sim_ros.rendering.look import SHADOW_COLOR
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.look import UNKNOWN_COLOR
from cloth_sim_ros.rendering.surface_programs import draw_cells
from cloth_sim_ros.rendering.surface_programs import draw_surface
from cloth_sim_ros.rendering.surface_programs import gap_defines
from cloth_sim_ros.rendering.surface_programs import SurfacePrograms
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
import numpy as np

_PALETTE_UNIT = 1     # render/strain_color.glsl

PALETTE_DEFINES = {'PALETTE_SIZE': PALETTE_SIZE}
HEM_WIDTH = 0.9      # [pixel of the picture]
_SHADOW_SIDE = 160    # most nodes of the shadow along a side

CLOTH_DEFINES = {
    **LIGHT_DEFINES, **PALETTE_DEFINES, 'HEM_SHADE': HEM_SHADE}
LIMIT_DEFINES = {
    **CLOTH_DEFINES, 'HAS_LIMITS': 1, 'FLAG_AT_LIMIT': FLAG_AT_LIMIT,
    # Radius of a dot on a node at its limit, over the shorter side of a cell, with its rim and
    # without; the grey of the rim; the tint where dots are too small to be seen one by one.
    'DOT_RADIUS': 0.33, 'DOT_INSIDE': 0.22, 'DOT_RIM': 0.1, 'DOT_TINT': 0.3}

_SHADOW_DEFINES = {'SHADOW': 1}


def surface_normals(positions: np.ndarray) -> np.ndarray:
    """
    Return unit normals, up for a cloth that lies flat with row 0 at the largest y.

    From central differences, one-sided ones at a border; (0, 0, 1) where the cloth has no area.

    :param positions: (rows, cols, 3) [m]; NaN where there is no node
    :return: (rows, cols, 3) float64
    """
    along, down = (_difference(positions, axis) for axis in (1, 0))
    normals = np.cross(down, along)
    length = np.linalg.norm(normals, axis=-1, keepdims=True)
    return np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), (0.0, 0.0, 1.0))


def _difference(positions: np.ndarray, axis: int) -> np.ndarray:
    """Return the way from the node before to the node after, itself where there is none."""
    count = positions.shape[axis]
    before = positions.take(np.maximum(np.arange(count) - 1, 0), axis)
    after = positions.take(np.minimum(np.arange(count) + 1, count - 1), axis)
    before, after = (
        np.where(np.isnan(other), positions, other) for other in (before, after))
    return after - before


class PaletteBuffer:
    """The palette of ``scale``, for render/strain_color.glsl."""

    def __init__(self, scale: StrainScale) -> None:
        """Write it to the device."""
        self._full = scale.full
        self._buffer = Buffer(scale.palette)

    def give(
            self, program: RenderProgram,
            plain: tuple[float, float, float] = UNKNOWN_COLOR) -> None:
        """
        Let ``program``, which is in use, take its colours from here.

        :param plain: the colour of what has no strain
        """
        self._buffer.bind_texture(_PALETTE_UNIT)
        program.set_float('full_strain', self._full)
        program.set_vectors('plain_color', plain)


class ClothDrawing:
    """
    Draws the frame in the node buffer, of two rows and two columns or more.

    :param detail: drawn pixels along each side of a pixel of the picture
    """

    def __init__(self, palette: PaletteBuffer, detail: int) -> None:
        """Keep what all frames share."""
        self._palette = palette
        self._detail = detail
        self._programs = SurfacePrograms()

    def draw(self, frame: Frame, view: View) -> None:
        """Draw the surface."""
        rows, cols = frame.records.shape
        has_limits = bool((frame.records['flags'] & FLAG_AT_LIMIT).any())
        gaps = gap_defines(frame)
        program = self._programs.of(
            'render/cloth.frag', {**(LIMIT_DEFINES if has_limits else CLOTH_DEFINES), **gaps})
        program.use()
        set_view(program, view)
        set_light(program, view)
        self._palette.give(program)
        program.set_int('rows', rows)
        program.set_pair('cell', cell_sides(frame.positions))
        program.set_float('hem_width', HEM_WIDTH * self._detail)
        program.set_vectors('limit_color', LIMIT_COLOR)
        draw_surface(program, (rows, cols), has_gaps=bool(gaps))

    def draw_shadow(self, frame: Frame, view: View, floor: float) -> None:
        """Draw the shadow on the floor at the height ``floor`` [m], over all before."""
        self.draw_shadow_of(frame.records.shape, view, floor, gap_defines(frame))

    def draw_shadow_of(
            self, shape: tuple[int, ...], view: View, floor: float,
            gaps: dict[str, int] | None = None) -> None:
        """
        Draw that of another surface in the node buffer.

        :param shape: rows and columns
        :param gaps: what ``gap_defines`` returns of it
        """
        rows, cols = shape
        program = self._programs.of('render/plain.frag', {**_SHADOW_DEFINES, **(gaps or {})})
        program.use()
        set_view(program, view)
        stride = math.ceil(max(rows, cols) / _SHADOW_SIDE)
        program.set_int('rows', rows)
        program.set_int('cols', cols)
        program.set_int('stride', stride)
        program.set_float('floor_z', floor - view.middle[2])
        program.set_vectors('plain_color', SHADOW_COLOR)
        draw_over_all()
        down, along = (math.ceil((count - 1) / stride) for count in (rows, cols))
        draw_cells(program, (down, along), has_gaps=bool(gaps))


def cell_sides(positions: np.ndarray) -> tuple[float, float]:
    """Return the sides of a cell along a row and along a column, the shorter one 1."""
    sides = [
        float(np.nanmedian(np.linalg.norm(np.diff(positions, axis=axis), axis=-1)))
        for axis in (1, 0)]
    shorter = min(sides)
    return (sides[0] / shorter, sides[1] / shorter) if shorter > 0.0 else (1.0, 1.0)
