# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the panels of a picture or of a video share, and how one of them is drawn."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.layout import Layout
from cloth_sim_ros.rendering.renderer import draw_panel
from cloth_sim_ros.rendering.renderer import Renderer
from cloth_sim_ros.rendering.sheet import Sheet
from cloth_sim_ros.rendering.source import Source
from cloth_sim_ros.rendering.strain_scale import StrainScale
from cloth_sim_ros.rendering.survey import Survey
import numpy as np


@dataclass(frozen=True)
class Style:
    """
    How a picture is to look.

    :param panel: width and height of a panel [pixel]; None chooses
    :param strain_max: strain of the last colour; None fits it to what is shown
    :param labels: names of the recordings; None takes their own
    :param title: heading; None says what is shown
    :param columns: most panels side by side, of one recording
    """

    camera: Camera = Camera()
    panel: tuple[int, int] | None = None
    strain_max: float | None = None
    labels: Sequence[str] | None = None
    title: str | None = None
    columns: int = 3


class Stage:
    """
    Draws whole pictures of frames, all seen alike.

    :param title: heading
    :param labels: of the rows, where ``layout`` has room for them
    :param detail: 2 draws four times the pixels, for still pictures
    """

    def __init__(
            self, survey: Survey, scale: StrainScale, layout: Layout, camera: Camera, *,
            title: str = '', labels: Sequence[str] = (), note: str = '',
            detail: int = 1) -> None:
        """Place the camera and draw what is around the panels."""
        self._survey = survey
        view = camera.looking_at(survey.points, *layout.panel)
        self._renderer = Renderer(survey, scale, view, detail)
        self._sheet = Sheet(
            layout, survey, scale, view, title=title, labels=labels, note=note)

    def draw(self, frames: Sequence[Frame], headings: Sequence[str]) -> np.ndarray:
        """Return the picture of ``frames``, a panel each, (height, width, 3) uint8."""
        font = self._sheet.layout.font
        return self._sheet.compose(
            [draw_panel(self._renderer, self._survey, frame, font) for frame in frames],
            headings)

    def close(self) -> None:
        """Give the device back."""
        self._renderer.close()


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
