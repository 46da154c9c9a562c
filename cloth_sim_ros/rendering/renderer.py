# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw a frame into an image, and the panels that a picture or a video is made of."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.gl.framebuffer import blend_by_opacity
from cloth_sim_ros.gl.framebuffer import draw_nearest
from cloth_sim_ros.gl.framebuffer import Framebuffer
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.cloth_drawing import ClothDrawing
from cloth_sim_ros.rendering.cloth_drawing import PaletteBuffer
from cloth_sim_ros.rendering.daylight import DaylightDrawing
from cloth_sim_ros.rendering.daylight import STRAIN
from cloth_sim_ros.rendering.look import BACKGROUND
from cloth_sim_ros.rendering.look import GRASP_COLOR
from cloth_sim_ros.rendering.look import LIMIT_COLOR
from cloth_sim_ros.rendering.look import PIN_COLOR
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.look import write_forces
from cloth_sim_ros.rendering.node_buffer import NodeBuffer
from cloth_sim_ros.rendering.sheet import Layout
from cloth_sim_ros.rendering.sheet import Sheet
from cloth_sim_ros.rendering.solid_drawing import BallDrawing
from cloth_sim_ros.rendering.solid_drawing import ColliderDrawing
from cloth_sim_ros.rendering.solid_drawing import FloorDrawing
from cloth_sim_ros.rendering.solid_drawing import PushDrawing
from cloth_sim_ros.rendering.solid_drawing import RibbonDrawing
from cloth_sim_ros.rendering.solid_drawing import seen_and_hidden
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.survey import region_rings
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.model.collider_surface import ground
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
import numpy as np

_CHAIN_WIDTH = 1.0 / 100.0  # of the shorter side of the picture
_CHAIN_RIM = 0.8            # [pixel]
_RING_WIDTH = 1.5
_LIMIT_SIZE = 0.55          # of the ball on a node at its limit, over that of a pin


class Renderer:
    """
    Draws frames, all seen alike.

    :param detail: 2 draws four times the pixels, for still pictures
    :param look: one of LOOKS
    :raises DeviceError: when there is no GL device, or it can't draw so large a picture
    """

    def __init__(
            self, survey: Survey, scale: StrainScale, view: View, detail: int = 1,
            look: str = STRAIN) -> None:
        """Make the context and the picture."""
        self.view = view
        self._survey = survey
        self._scale = scale
        self._detail = detail
        self._look = look
        self._context = Context()
        if not self._context.max_texture_texels:
            raise DeviceError(
                f'{self._context.device} lacks texture buffers, which rendering needs: render on '
                'another device')
        self._framebuffer = Framebuffer(view.width, view.height, detail)
        self._nodes = NodeBuffer(self._context.max_texture_texels)
        self._lines = NodeBuffer(self._context.max_texture_texels)

    @property
    def device(self) -> str:
        """Name the device that draws."""
        return self._context.device

    def draw(self, frame: Frame) -> np.ndarray:
        """Return the image of ``frame``, (height, width, 3) uint8, the uppermost line first."""
        self._context.make_current()
        is_chain = min(frame.records.shape) == 1
        level = ground(frame.colliders)
        floor = self._survey.floor if level is None else level
        if self._look == STRAIN:
            self._framebuffer.begin(BACKGROUND)
            blend_by_opacity()
            self._draw_with_strains(frame, floor, has_ground=level is not None)
        else:
            self._daylight.cast(frame, self.view)
            self._framebuffer.begin(BACKGROUND)
            blend_by_opacity()
            self._daylight.draw(frame, self.view, floor)
        if is_chain:
            self._draw_chain(frame)
        self._pushes.draw(self._survey.arrows(frame), self.view)
        self._draw_rings(frame)
        self._balls.draw(frame.positions[frame.pinned & ~frame.grasped], self.view, PIN_COLOR)
        self._balls.draw(frame.positions[frame.grasped], self.view, GRASP_COLOR)
        return self._framebuffer.read()

    def close(self) -> None:
        """Release the device."""
        self._context.close()

    def _draw_with_strains(self, frame: Frame, floor: float, *, has_ground: bool) -> None:
        """Draw a floor at the height ``floor`` [m], the cloth unless it is a chain, and bodies."""
        is_chain = min(frame.records.shape) == 1
        # From below, the floor would hide what lies on it.
        is_above = self.view.is_above(floor)
        if has_ground and is_above:
            self._floor.draw_ground(self.view, floor)
        if frame.colliders and is_above:
            self._colliders.draw_shadows(frame.colliders, self.view, floor)
        self._nodes.load(frame, self.view.middle)
        if not is_chain and is_above:
            self._cloth.draw_shadow(frame, self.view, floor)
        self._floor.draw(self.view, floor)
        draw_nearest()
        if not is_chain:
            self._cloth.draw(frame, self.view)
        if frame.colliders:
            self._colliders.draw(frame.colliders, self.view)

    def _draw_chain(self, frame: Frame) -> None:
        if self._look == STRAIN:
            self._nodes.load(frame, self.view.middle)
        else:
            self._nodes.load_points(frame.positions, self.view.middle)
        draw_nearest()
        self._ribbon.draw(
            frame.records.size, self.view,
            _CHAIN_WIDTH * min(self.view.width, self.view.height), rim=_CHAIN_RIM)
        if self._look == STRAIN:
            self._balls.draw(
                frame.positions[(frame.records['flags'] & FLAG_AT_LIMIT) != 0], self.view,
                LIMIT_COLOR, _LIMIT_SIZE)

    def _draw_rings(self, frame: Frame) -> None:
        for ring in region_rings(frame.acting_pushes, self.view.axes):
            self._lines.load_points(ring, self.view.middle)
            for opacity in seen_and_hidden():
                self._ribbon.draw(
                    len(ring), self.view, _RING_WIDTH, opacity=opacity, color=PUSH_COLOR)

    # Each is made, and its shaders compiled, when it is first drawn.

    @cached_property
    def _palette(self) -> PaletteBuffer:
        return PaletteBuffer(self._scale)

    @cached_property
    def _cloth(self) -> ClothDrawing:
        return ClothDrawing(self._palette, self._detail)

    @cached_property
    def _ribbon(self) -> RibbonDrawing:
        return RibbonDrawing(self._palette, self._detail)

    @cached_property
    def _floor(self) -> FloorDrawing:
        return FloorDrawing(self._survey, self._detail)

    @cached_property
    def _colliders(self) -> ColliderDrawing:
        return ColliderDrawing(
            self._cloth, NodeBuffer(self._context.max_texture_texels), self._survey)

    @cached_property
    def _daylight(self) -> DaylightDrawing:
        return DaylightDrawing(
            self._look, self._nodes, NodeBuffer(self._context.max_texture_texels), self._survey,
            self._detail)

    @cached_property
    def _balls(self) -> BallDrawing:
        return BallDrawing(self._detail)

    @cached_property
    def _pushes(self) -> PushDrawing:
        return PushDrawing(self._survey.arrow_length)


def draw_panel(renderer: Renderer, survey: Survey, frame: Frame, font: int) -> np.ndarray:
    """
    Return the image of ``frame``, (height, width, 3) uint8.

    :param font: height of the letters [pixel]
    """
    image = renderer.draw(frame)
    write_forces(
        image, frame.acting_pushes, survey.arrows(frame), renderer.view, font)
    return image


@dataclass(frozen=True)
class Style:
    """
    How a picture is to look.

    :param panel: width and height of a panel [pixel]; None chooses
    :param strain_max: strain of the last colour; None fits it to what is shown
    :param labels: names of the recordings; None takes their own
    :param title: heading; None says what is shown
    :param columns: most panels side by side, of one recording
    :param look: one of LOOKS
    """

    camera: Camera = Camera()
    panel: tuple[int, int] | None = None
    strain_max: float | None = None
    labels: Sequence[str] | None = None
    title: str | None = None
    columns: int = 3
    look: str = STRAIN


class Stage:
    """
    Draws whole pictures of frames, all seen alike.

    :param title: heading
    :param labels: of the rows, where ``layout`` has room for them
    :param detail: 2 draws four times the pixels, for still pictures
    """

    def __init__(
            self, survey: Survey, scale: StrainScale, layout: Layout, camera: Camera, *,
            title: str = '', labels: Sequence[str] = (), note: str = '', detail: int = 1,
            look: str = STRAIN) -> None:
        """Place the camera and draw what is around the panels."""
        self._survey = survey
        view = camera.looking_at(survey.points, *layout.panel)
        self._renderer = Renderer(survey, scale, view, detail, look)
        self._sheet = Sheet(
            layout, survey, scale, view, title=title, labels=labels, note=note, look=look)

    def draw(self, frames: Sequence[Frame], headings: Sequence[str]) -> np.ndarray:
        """Return the picture of ``frames``, a panel each, (height, width, 3) uint8."""
        font = self._sheet.layout.font
        return self._sheet.compose(
            [draw_panel(self._renderer, self._survey, frame, font) for frame in frames],
            headings)

    def close(self) -> None:
        """Release the device."""
        self._renderer.close()


def has_bar(scale: StrainScale, style: Style) -> bool:
    """Return whether a picture shows strains, and needs a colour bar."""
    return scale.is_known and style.look == STRAIN


def title_of(sources: Sequence[Source], frames: Sequence[Frame]) -> str:
    """Return a heading: the nodes, where all cloths have as many, and the modes."""
    sizes = {frame.records.shape for frame in frames}
    words = ['{} x {} nodes'.format(*size) for size in sizes] if len(sizes) == 1 else []
    if len(sources) == 1 and sources[0].modes:
        words.append(', '.join(sources[0].modes))
    return ', '.join(words)


def labels_of(sources: Sequence[Source], style: Style) -> list[str]:
    """Return a name for each of ``sources``: its own and its modes, or what ``style`` says."""
    if style.labels is not None:
        return list(style.labels)
    return [
        f'{source.name} ({", ".join(source.modes)})' if source.modes else source.name
        for source in sources]


def note_of(sources: Sequence[Source]) -> str:
    """Return where the runs were made, and what can't be drawn."""
    devices = dict.fromkeys(source.device for source in sources if source.device)
    missing = [
        f'{source.name} lacks {" and ".join(source.missing)}: not drawn'
        for source in sources if source.missing]
    simulated = [f'simulated on {", ".join(devices)}'] if devices else []
    return '; '.join([*simulated, *missing])
