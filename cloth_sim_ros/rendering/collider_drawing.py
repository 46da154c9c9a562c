# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw what the cloth can touch."""

from collections.abc import Iterable
from functools import cached_property

from cloth_sim_ros.analysis.collider_surface import collider_surface
from cloth_sim_ros.analysis.collider_surface import is_ground
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import set_view
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.cloth_drawing import ClothDrawing
from cloth_sim_ros.rendering.look import COLLIDER_COLOR
from cloth_sim_ros.rendering.look import LIGHT_DEFINES
from cloth_sim_ros.rendering.look import set_light
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.colliders import Collider

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
