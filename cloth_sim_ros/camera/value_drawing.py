# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Measure depth, label and normals of what each pixel sees."""

from collections.abc import Mapping
import math

from cloth_sim_ros.camera.dip import dip_of
from cloth_sim_ros.camera.drawn_cloth import DrawnCloth
from cloth_sim_ros.camera.lens import Lens
from cloth_sim_ros.camera.subject import Subject
from cloth_sim_ros.camera.traced_body import set_traced_body
from cloth_sim_ros.camera.traced_body import traced_defines
from cloth_sim_ros.gl.framebuffer import clamp_depths
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.framebuffer import draw_within
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.gl.value_images import BYTES
from cloth_sim_ros.gl.value_images import FLOATS
from cloth_sim_ros.gl.value_images import FOUR_FLOATS
from cloth_sim_ros.gl.value_images import ValueImages
from cloth_sim_ros.sim.model.colliders import Collider
import numpy as np

# Labels of a picture; the first collider has the next one.
BACKGROUND, CLOTH = 0, 1
FIRST_COLLIDER = 2
_DEPTH, _LABEL, _NORMAL, _FACET = range(4)
_NORMALS = {'HAS_NORMALS': 1}


class Values:
    """
    Measured values.

    :param depth: (height, width) float32 [m]; inf where nothing is, -inf where it is too near
    :param labels: (height, width) uint8
    :param normals: (height, width, 3) float32, in the optical frame; None where not requested
    :param facets: normal n and offset d of the plane n . X = d that a pixel sees, (height, width,
        4) float32 [m]; None where not requested
    """

    def __init__(
            self, depth: np.ndarray, labels: np.ndarray, normals: np.ndarray | None,
            facets: np.ndarray | None) -> None:
        """Keep them."""
        self.depth = depth
        self.labels = labels
        self.normals = normals
        self.facets = facets


class ValueDrawing:
    """Draws the values of pictures of ``width`` x ``height`` pixels, in the current context."""

    def __init__(self, width: int, height: int) -> None:
        """Begin without memory: it is allocated when something is first requested."""
        self._size = width, height
        self._images: dict[bool, ValueImages] = {}
        self._programs: dict[tuple[str, ...], RenderProgram] = {}

    def draw(
            self, subject: Subject, cloth: DrawnCloth, lens: Lens, *,
            has_normals: bool = False) -> Values:
        """
        Return what the camera measures.

        :param cloth: has ``subject`` loaded
        :param has_normals: measure normals and facets as well
        """
        images = self._begin(has_normals)
        draw_nearest()
        clamp_depths(True)
        defines = _NORMALS if has_normals else {}
        program = self._program(
            'camera/cloth.vert', 'camera/cloth_values.frag', {**defines, **cloth.defines})
        program.use()
        program.set_int('label', CLOTH)
        cloth.bind()
        cloth.draw(program, lens)
        for number, collider in enumerate(subject.colliders):
            self._draw_body(
                collider, FIRST_COLLIDER + number, lens, dip_of(collider, subject), defines)
        clamp_depths(False)
        values = Values(
            images.read(_DEPTH), images.read(_LABEL),
            images.read(_NORMAL)[..., :3] if has_normals else None,
            images.read(_FACET) if has_normals else None)
        return values

    def _begin(self, has_normals: bool) -> ValueImages:
        if has_normals not in self._images:
            kinds = [FLOATS, BYTES, *((FOUR_FLOATS, FOUR_FLOATS) if has_normals else ())]
            self._images[has_normals] = ValueImages(*self._size, kinds)
        images = self._images[has_normals]
        images.begin((math.inf, BACKGROUND, math.nan, math.nan))
        return images

    def _draw_body(
            self, collider: Collider, label: int, lens: Lens, dip: float,
            defines: Mapping[str, object]) -> None:
        rectangle = _rectangle(collider, lens)
        if rectangle is None:
            return
        program = self._program(
            'camera/screen.vert', 'camera/body_values.frag',
            {**defines, **traced_defines(collider.shape)})
        program.use()
        lens.set_in(program)
        program.set_int('label', label)
        program.set_vectors('body_axes', collider.axes @ lens.pose.axes.T)
        set_traced_body(program, collider, lens, dip)
        with draw_within(*rectangle):
            program.draw_strips(4)

    def _program(
            self, vertex: str, fragment: str, defines: Mapping[str, object]) -> RenderProgram:
        key = (fragment, *(f'{name}={value}' for name, value in sorted(defines.items())))
        if key not in self._programs:
            self._programs[key] = RenderProgram(vertex, fragment, defines)
        return self._programs[key]


def _rectangle(collider: Collider, lens: Lens) -> tuple[int, int, int, int] | None:
    if collider.shape == 'plane':
        return 0, 0, lens.model.width, lens.model.height
    radius, length = collider.size[0], collider.size[-1]
    half = {
        'sphere': (radius, radius, radius),
        'capsule': (radius, radius, length / 2.0 + radius),
        'cylinder': (radius, radius, length / 2.0),
        'box': tuple(np.array(collider.size) / 2.0),
    }[collider.shape]
    signs = np.array(np.meshgrid(*3 * [(-1.0, 1.0)])).reshape(3, -1).T
    return lens.rectangle(collider.pose.in_world(signs * half))
