# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw the cells of a lattice of nodes: all of them, or those of a shape."""

from collections.abc import Mapping

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.sim.snapshot import FLAG_GAP

# A cloth that is cut to a shape.
GAP_DEFINES = {'HAS_GAPS': 1, 'FLAG_GAP': FLAG_GAP}


def gap_defines(frame: Frame) -> dict[str, int]:
    """Return what shaders need that draw ``frame``: nothing for a whole rectangle."""
    return GAP_DEFINES if (frame.records['flags'] & FLAG_GAP).any() else {}


def draw_surface(
        program: RenderProgram, shape: tuple[int, ...], *, has_gaps: bool = False) -> None:
    """
    Draw the cells in the node buffer with ``program``, of render/cloth.vert.

    :param shape: rows and columns of nodes
    :param has_gaps: whether it was made with GAP_DEFINES
    """
    rows, cols = shape
    program.set_int('cols', cols)
    draw_cells(program, (rows - 1, cols - 1), has_gaps=has_gaps)


def draw_cells(program: RenderProgram, cells: tuple[int, int], *, has_gaps: bool) -> None:
    """Draw so many rows and columns of cells."""
    down, along = cells
    if has_gaps:
        program.draw_triangles(6 * along, down)
    else:
        program.draw_strips(2 * (along + 1), down)


class SurfacePrograms:
    """Programs that draw surfaces with render/cloth.vert; each is made when it is first used."""

    def __init__(self) -> None:
        """Begin with none."""
        self._made: dict[tuple[object, ...], RenderProgram] = {}

    def of(self, fragments: str, defines: Mapping[str, object]) -> RenderProgram:
        """Return the one with the shader ``fragments``, compiled with ``defines``."""
        key = (fragments, *sorted(defines.items()))
        if key not in self._made:
            self._made[key] = RenderProgram('render/cloth.vert', fragments, defines)
        return self._made[key]
