# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw cloth and bodies in colour, in the light of a sun that casts soft shadows."""

from collections.abc import Mapping
from functools import cached_property

from cloth_sim_ros.camera.dip import dip_of
from cloth_sim_ros.camera.drawn_cloth import DrawnCloth
from cloth_sim_ros.camera.lens import Lens
from cloth_sim_ros.camera.light import DAYLIGHT_DEFINES
from cloth_sim_ros.camera.light import DEPTH_PIXEL
from cloth_sim_ros.camera.light import DEPTH_SIDES
from cloth_sim_ros.camera.light import DEPTH_UNIT
from cloth_sim_ros.camera.light import NEAREST_DEPTH_UNIT
from cloth_sim_ros.camera.picture_file import load_picture
from cloth_sim_ros.camera.subject import Subject
from cloth_sim_ros.camera.traced_body import set_traced_body
from cloth_sim_ros.camera.traced_body import traced_defines
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.framebuffer import clamp_depths
from cloth_sim_ros.gl.framebuffer import DepthTexture
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.framebuffer import draw_over_all
from cloth_sim_ros.gl.framebuffer import Framebuffer
from cloth_sim_ros.gl.picture_texture import PictureTexture
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.sim.model.collider_surface import local_surface
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Look
from cloth_sim_ros.sim.model.scene_fields import CHECKED
from cloth_sim_ros.sim.model.scene_fields import PLAIN
from cloth_sim_ros.sim.model.scene_fields import WOVEN
import numpy as np

# What shaders compile in for each pattern.
FABRIC_DEFINES: Mapping[str, Mapping[str, int]] = {
    PLAIN: {}, CHECKED: {'HAS_PATTERN': 1, 'CHECKED': 1}, WOVEN: {'HAS_PATTERN': 1, 'WOVEN': 1}}
PRINT_DEFINES = {'PRINTED': 1}
_PICTURE_UNIT = 3   # camera/fabric.glsl and camera/backdrop.frag
_SURFACE_UNIT = 0   # camera/solid.glsl
_MARGIN = 1.05      # what the sun sees over what casts shadows
_SMALLEST = 1e-3    # a scene of one point still has a size [m]
_AROUND_PLANE = 2.0  # half a side of a plane that is drawn, over far


class ColorDrawing:
    """
    Draws pictures of ``width`` x ``height`` pixels, in the current context.

    :param samples: of the colour of a pixel
    """

    def __init__(self, width: int, height: int, samples: int) -> None:
        """Begin without memory."""
        self._size = width, height
        self._samples = samples
        self._programs: dict[tuple[str, ...], RenderProgram] = {}
        self._pictures: dict[str, PictureTexture] = {}
        self._depths: dict[int, DepthTexture] = {}
        self._surfaces: dict[tuple[str, tuple[float, ...]], tuple[Buffer, int, int]] = {}

    def draw(
            self, subject: Subject, cloth: DrawnCloth, lens: Lens, look: Look,
            nodes: np.ndarray) -> np.ndarray:
        """
        Return the picture, (height, width, 3) uint8.

        :param cloth: has ``subject`` loaded
        :param nodes: where its nodes are, (rows, cols, 3) [m]: where there can be shadows
        """
        sun = _Sun(look.sun, subject, lens, nodes)
        depths = self._depths_for(2.0 * sun.reach, look.shadow)
        self._cast(subject, cloth, lens, sun, depths)
        depths.bind(DEPTH_UNIT)
        depths.bind_nearest(NEAREST_DEPTH_UNIT)
        self._framebuffer.begin(look.background)
        if look.backdrop:
            self._draw_backdrop(look)
        draw_nearest()
        clamp_depths(True)
        self._draw_cloth(subject, cloth, lens, look, sun)
        self._draw_bodies(subject, lens, look, sun)
        clamp_depths(False)
        return self._framebuffer.read(is_upside_down=True)

    def _cast(
            self, subject: Subject, cloth: DrawnCloth, lens: Lens, sun: '_Sun',
            depths: DepthTexture) -> None:
        """Draw what the sun sees into ``depths``."""
        depths.begin()
        draw_nearest()
        clamp_depths(True)
        program = self._program('camera/cloth_depth.vert', 'camera/nothing.frag', cloth.defines)
        program.use()
        lens.set_eye_in(program)
        program.set_matrix('lamp_matrix', sun.matrix)
        cloth.bind()
        cloth.draw_surface(program)
        program = self._program('camera/body_depth.vert', 'camera/nothing.frag', {})
        program.use()
        program.set_matrix('lamp_matrix', sun.matrix)
        for collider in subject.colliders:
            if collider.shape != 'plane':
                self._draw_surface(program, collider, lens)

    def _draw_cloth(
            self, subject: Subject, cloth: DrawnCloth, lens: Lens, look: Look,
            sun: '_Sun') -> None:
        program = self._program(
            'camera/cloth.vert', 'camera/cloth_color.frag',
            {**DAYLIGHT_DEFINES,
             **(PRINT_DEFINES if look.texture else FABRIC_DEFINES[look.fabric]),
             **cloth.defines})
        program.use()
        if look.texture:
            self._picture(look.texture, 'look.texture').bind(_PICTURE_UNIT)
            along, down = subject.cell
            program.set_pair('cloth_size', (
                (subject.shape[1] - 1) * along, (subject.shape[0] - 1) * down))
        self._light(program, look, sun)
        program.set_vectors('front_color', look.color)
        program.set_vectors('back_color', look.back_color)
        program.set_vectors('second_color', look.second_color)
        program.set_float('pitch', look.pitch)
        program.set_pair('cell', subject.cell)
        cloth.bind()
        cloth.draw(program, lens)

    def _draw_backdrop(self, look: Look) -> None:
        program = self._program('camera/screen.vert', 'camera/backdrop.frag', {})
        program.use()
        self._picture(look.backdrop, 'look.backdrop').bind(_PICTURE_UNIT)
        program.set_pair('picture_size', self._size)
        draw_over_all()
        program.draw_strips(4)

    def _picture(self, path: str, parameter: str) -> PictureTexture:
        """Return the picture in a file; it is read once."""
        if path not in self._pictures:
            self._pictures[path] = PictureTexture(load_picture(path, parameter))
        return self._pictures[path]

    def _draw_bodies(self, subject: Subject, lens: Lens, look: Look, sun: '_Sun') -> None:
        for collider in subject.colliders:
            is_plane = collider.shape == 'plane'
            if is_plane and not _is_above(lens, collider):
                continue
            program = self._program(
                'camera/body.vert', 'camera/body_color.frag',
                {**DAYLIGHT_DEFINES, **({} if is_plane else traced_defines(collider.shape))})
            program.use()
            self._light(program, look, sun)
            lens.set_in(program)
            program.set_vectors('body_color', look.of_body(collider.name, collider.shape))
            dip = dip_of(collider, subject)
            if is_plane:
                program.set_float('lowered', dip)
            else:
                program.set_float('lowered', 0.0)
                set_traced_body(program, collider, lens, dip)
            self._draw_surface(program, collider, lens)

    def _light(self, program: RenderProgram, look: Look, sun: '_Sun') -> None:
        """Set the uniforms of render/lamp.glsl in ``program``, which is in use."""
        program.set_matrix('lamp_matrix', sun.matrix)
        program.set_vectors('lamp', sun.axes[2])
        program.set_float('lamp_blur', look.shadow / (2.0 * sun.reach))
        program.set_float('lamp_lift', look.shadow)

    def _draw_surface(self, program: RenderProgram, collider: Collider, lens: Lens) -> None:
        """Draw a body with ``program``, of camera/solid.glsl and in use."""
        buffer, rows, cols = self._surface(collider)
        buffer.bind_texture(_SURFACE_UNIT)
        place = np.array(collider.position)
        stretch = 1.0
        if collider.shape == 'plane':
            # The part of it that is next to the camera.
            stretch = _AROUND_PLANE * lens.model.far
            foot = collider.pose.seen_from(np.array(lens.pose.position)) * (1.0, 1.0, 0.0)
            place = collider.pose.in_world(foot)
        program.set_int('cols', cols)
        program.set_vectors('body_axes', collider.axes)
        program.set_vectors('body_place', place - np.array(lens.pose.position))
        program.set_float('stretch', stretch)
        program.draw_strips(2 * cols, rows - 1)

    def _surface(self, collider: Collider) -> tuple[Buffer, int, int]:
        key = collider.shape, collider.size
        if key not in self._surfaces:
            points, normals = local_surface(*key)
            rows, cols = points.shape[:2]
            packed = np.zeros((rows, cols, 8), np.float32)
            packed[..., :3], packed[..., 4:7] = points, normals
            self._surfaces[key] = Buffer(packed), rows, cols
        return self._surfaces[key]

    def _program(
            self, vertex: str, fragment: str, defines: Mapping[str, object]) -> RenderProgram:
        key = (
            vertex, fragment, *(f'{name}={value}' for name, value in sorted(defines.items())))
        if key not in self._programs:
            self._programs[key] = RenderProgram(vertex, fragment, defines)
        return self._programs[key]

    @cached_property
    def _framebuffer(self) -> Framebuffer:
        return Framebuffer(*self._size, most_samples=self._samples)

    def _depths_for(self, length: float, shadow: float) -> DepthTexture:
        """
        Return the texture for shadows with a soft edge of radius ``shadow`` [m].

        :param length: of the side of what the sun sees [m]
        """
        side = next(
            (each for each in DEPTH_SIDES if length <= each * DEPTH_PIXEL * shadow),
            DEPTH_SIDES[-1])
        if side not in self._depths:
            self._depths[side] = DepthTexture(side)
        return self._depths[side]


class _Sun:
    """
    How the sun sees what casts shadows, with parallel rays.

    :param direction: to it, of any length
    """

    def __init__(
            self, direction: tuple[float, float, float], subject: Subject, lens: Lens,
            nodes: np.ndarray) -> None:
        """Fit its view to the cloth and to all bodies but planes."""
        towards = np.array(direction) / np.linalg.norm(direction)
        side = (1.0, 0.0, 0.0) if abs(towards[0]) < 0.9 else (0.0, 1.0, 0.0)
        right = np.cross(side, towards)
        right /= np.linalg.norm(right)
        # Right, up and towards the sun.
        self.axes = np.stack([right, np.cross(towards, right), towards])
        places = [nodes.reshape(-1, 3)[np.isfinite(nodes).all(axis=-1).ravel()]]
        places += [
            collider.pose.in_world(local_surface(collider.shape, collider.size)[0].reshape(-1, 3))
            for collider in subject.colliders if collider.shape != 'plane']
        seen = np.concatenate([(each @ self.axes.T) for each in places])
        low, high = seen.min(axis=0), seen.max(axis=0)
        middle = (low + high) / 2.0
        half = _MARGIN * (high - low) / 2.0
        self.reach = max(float(half[0]), float(half[1]), _SMALLEST)
        depth = max(float(half[2]), _SMALLEST)
        eye = self.axes @ np.array(lens.pose.position)
        offset = eye - middle
        self.matrix = np.stack([
            np.append(self.axes[0], offset[0]) / self.reach,
            np.append(self.axes[1], offset[1]) / self.reach,
            np.append(-self.axes[2], -offset[2]) / depth,
            (0.0, 0.0, 0.0, 1.0)])


def _is_above(lens: Lens, plane: Collider) -> bool:
    return bool(plane.pose.seen_from(np.array(lens.pose.position))[2] > 0.0)
