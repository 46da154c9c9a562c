# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compose images, headings and a legend to a sheet: where its parts are, and what they show."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.daylight import STRAIN
from cloth_sim_ros.rendering.look import COLLIDER_COLOR
from cloth_sim_ros.rendering.look import GRASP_COLOR
from cloth_sim_ros.rendering.look import GRID_COLOR
from cloth_sim_ros.rendering.look import LIMIT_COLOR
from cloth_sim_ros.rendering.look import PIN_COLOR
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.look import write_words
from cloth_sim_ros.rendering.solid_drawing import grid_step
from cloth_sim_ros.rendering.survey import Survey
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
import numpy as np

_WIDTH = 540          # [pixel]
_SLIMMEST = 1.7       # longer over shorter side
_SMALLEST_FONT, _LARGEST_FONT = 11, 34
_SMALLEST_SIDE = 32       # of a panel [pixel]
_FONT_SHARE = 1.0 / 36.0  # of the width of a panel that is not much wider than high


def panel_size(points: np.ndarray, camera: Camera) -> tuple[int, int]:
    """
    Return width and height [pixel] of a panel that ``points`` fill well.

    :param points: (n, 3) [m]
    """
    across, up = ((points - points.mean(axis=0)) @ camera.axes[:2].T).T
    wide, high = np.ptp(across), np.ptp(up)
    ratio = float(np.clip(high / max(wide, 1e-12), 1.0 / _SLIMMEST, _SLIMMEST))
    # A slim panel is made narrower, so that a sheet of them is not too high.
    width = round(_WIDTH / max(1.0, ratio) ** 0.5)
    return width, round(width * ratio)


@dataclass(frozen=True)
class Layout:
    """
    A grid of panels with a heading each, a title above, a colour bar and a legend.

    :param panel: width and height of a panel [pixel]
    :param has_title: leave room for a title
    :param has_labels: leave room for the name of each row
    :param has_bar: leave room for a colour bar
    :param letters: their height [pixel]; 0 fits it to the panels
    """

    rows: int
    columns: int
    panel: tuple[int, int]
    has_title: bool = True
    has_labels: bool = False
    has_bar: bool = True
    letters: int = 0

    @property
    def font(self) -> int:
        """Get the height of the letters [pixel]."""
        if self.letters:
            return self.letters
        # Many small panels make a large sheet, which is looked at from farther away.
        share = _FONT_SHARE * (1.0 + 0.1 * (self.columns - 1)) * min(
            self.panel[0], 1.1 * self.panel[1])
        return round(min(max(share, _SMALLEST_FONT), _LARGEST_FONT))

    @property
    def size(self) -> tuple[int, int]:
        """Get the width and the height of the sheet [pixel], even as video needs them."""
        width = self.bar_left + self.bar_width
        height = self.top + self.rows * (self.heading + self.panel[1]) + self.legend_height
        return width + width % 2, height + height % 2

    @property
    def left(self) -> int:
        """Get the room left of the panels [pixel]."""
        return 2 * self.font if self.has_labels else 0

    @property
    def gap(self) -> int:
        """Get the distance of two columns [pixel]."""
        return self.font // 2

    @property
    def bar_left(self) -> int:
        """Get where the panels end and the room for the colour bar begins [pixel]."""
        return self.left + self.columns * (self.panel[0] + self.gap) - self.gap

    @property
    def middle(self) -> float:
        """Get the middle of the panels from the left [pixel]."""
        return (self.left + self.bar_left) / 2.0

    @property
    def top(self) -> int:
        """Get the room for the title [pixel]."""
        return round(2.4 * self.font) if self.has_title else self.font // 2

    @property
    def heading(self) -> int:
        """Get the room above each panel [pixel]."""
        return round(1.9 * self.font)

    @property
    def bar_width(self) -> int:
        """Get the room for the colour bar [pixel]."""
        return round(6.2 * self.font) if self.has_bar else 0

    @property
    def legend_height(self) -> int:
        """Get the room below the panels [pixel]."""
        return round(4.2 * self.font)

    def corner(self, number: int) -> tuple[int, int]:
        """Return the left upper corner of the heading of a panel, counted along the rows."""
        row, column = divmod(number, self.columns)
        return (
            self.left + column * (self.panel[0] + self.gap),
            self.top + row * (self.heading + self.panel[1]))

    @classmethod
    def within(cls, width: int, height: int, **parts: Any) -> 'Layout':
        """Return the layout whose sheet is about ``width`` x ``height`` pixels as a whole."""
        layout = cls(panel=(width // parts['columns'], height // parts['rows']), **parts)
        letters = layout.font
        for _ in range(2):
            over = layout.size[0] - width, layout.size[1] - height
            panel = (
                max(layout.panel[0] - round(over[0] / layout.columns), _SMALLEST_SIDE),
                max(layout.panel[1] - round(over[1] / layout.rows), _SMALLEST_SIDE))
            layout = cls(panel=panel, letters=letters, **parts)
        return layout


# Compose images, headings and a legend to a sheet.

_INK = '#303030'
_POINTS_PER_INCH = 72.0  # so that a point is a pixel
_LETTERS = 1.7           # height of a letter over its usual width


def legend_handles(
        survey: Survey, view: View, grid: float, size: float, look: str = STRAIN) -> list[Line2D]:
    """
    Return an entry for each kind of mark that some panel has in its picture.

    :param view: of all panels
    :param grid: distance of the grid's lines [m]
    :param size: of the marks [point]
    :param look: one of LOOKS; a fabric in daylight has no grid, and bodies explain themselves
    """
    entries: list[tuple[str, dict[str, Any]]] = []
    if look == STRAIN:
        entries.append((f'grid {grid:g} m', {'color': GRID_COLOR, 'linewidth': 1.5}))
        if survey.shows_colliders:
            entries.append(('collider', {**_dot(COLLIDER_COLOR, size), 'marker': 's'}))
    if view.may_show(survey.pins.corners):
        entries.append(('pinned', _dot(PIN_COLOR, size)))
    if view.may_show(survey.grasps.corners):
        entries.append(('grasped', _dot(GRASP_COLOR, size)))
    if survey.shows_pushes:
        # An arrowhead at the end of its shaft.
        entries.append(('push', {
            'color': PUSH_COLOR, 'linewidth': 2.0, 'marker': '>', 'markersize': size,
            'markevery': [1]}))
    if look == STRAIN and view.may_show(survey.limits.corners):
        entries.append(('node at its strain limit', _dot(LIMIT_COLOR, 0.8 * size)))
    return [Line2D([0.0, 1.0], [0.0, 0.0], label=label, **look) for label, look in entries]


def _dot(color: tuple[float, float, float], size: float) -> dict[str, Any]:
    return {
        'linestyle': 'none', 'marker': 'o', 'color': color, 'markersize': size,
        'markevery': [0], 'markeredgewidth': 0.0}


class Sheet:
    """
    A picture of many panels. What is around them is drawn once.

    :param labels: the name of each row; none when the layout has no room for them
    :param note: written below
    """

    def __init__(
            self, layout: Layout, survey: Survey, scale: StrainScale, view: View, *,
            title: str = '', labels: Sequence[str] = (), note: str = '',
            look: str = STRAIN) -> None:
        """Draw what is around the panels."""
        self.layout = layout
        width, height = layout.size
        self._figure = Figure(
            figsize=(width / _POINTS_PER_INCH, height / _POINTS_PER_INCH),
            dpi=_POINTS_PER_INCH)
        self._write(title, labels)
        if layout.has_bar:
            self._draw_bar(scale)
        self._draw_directions(view)
        self._explain(survey, view, note, look)
        canvas = FigureCanvasAgg(self._figure)
        canvas.draw()
        self._around = np.asarray(canvas.buffer_rgba())[..., :3].copy()

    def compose(self, images: Sequence[np.ndarray], headings: Sequence[str]) -> np.ndarray:
        """
        Return the whole picture, (height, width, 3) uint8.

        :param images: of the panels, along the rows
        :param headings: written above each
        """
        layout = self.layout
        whole = self._around.copy()
        for number, (image, heading) in enumerate(zip(images, headings)):
            left, top = layout.corner(number)
            upper = top + layout.heading
            whole[upper:upper + layout.panel[1], left:left + layout.panel[0]] = image
            strip = whole[top:upper, left:left + layout.panel[0]]
            write_words(
                strip, heading, (layout.panel[0] / 2.0, layout.heading / 2.0), layout.font)
        return whole

    def _write(self, title: str, labels: Sequence[str]) -> None:
        layout = self.layout
        width, height = layout.size
        middle = layout.middle / width
        self._figure.text(
            middle, 1.0 - 0.55 * layout.top / height, title, fontsize=1.15 * layout.font,
            color=_INK, ha='center', va='center')
        for row, label in enumerate(labels if layout.has_labels else ()):
            _, top = layout.corner(row * layout.columns)
            self._figure.text(
                0.6 * layout.left / width,
                1.0 - (top + layout.heading + layout.panel[1] / 2.0) / height, label,
                fontsize=layout.font, color=_INK, ha='center', va='center', rotation=90)

    def _draw_bar(self, scale: StrainScale) -> None:
        layout = self.layout
        width, height = layout.size
        room = height - layout.top - layout.legend_height
        long = min(0.84 * room, 26.0 * layout.font)
        left = layout.bar_left + 0.9 * layout.font
        bottom = layout.legend_height + (room - long) / 2.0
        axes = self._figure.add_axes((
            left / width, bottom / height, 1.1 * layout.font / width, long / height))
        bar = self._figure.colorbar(
            scale.in_percent, cax=axes, extend='max' if scale.is_exceeded else 'neither')
        bar.set_label(
            f'strain |l / L0 - 1| [%], largest shown {100.0 * scale.largest:.3g} %', color=_INK,
            fontsize=0.9 * layout.font)
        bar.ax.tick_params(labelsize=0.9 * layout.font, labelcolor=_INK)
        bar.outline.set_linewidth(0.5)

    def _draw_directions(self, view: View) -> None:
        """Draw the directions x, y and z into the lower left corner."""
        layout = self.layout
        width, height = layout.size
        side = layout.legend_height
        axes = self._figure.add_axes((0.0, 0.0, side / width, side / height))
        axes.set_xlim(-1.5, 1.5)
        axes.set_ylim(-1.1, 1.9)
        axes.axis('off')
        for name, direction in zip('xyz', view.axes[:2].T):
            # A direction towards the camera has no arrow.
            if np.linalg.norm(direction) > 0.1:
                axes.annotate('', direction, (0.0, 0.0), arrowprops={
                    'arrowstyle': '->', 'color': _INK, 'shrinkA': 0.0, 'shrinkB': 0.0,
                    'mutation_scale': 0.7 * layout.font})
            axes.text(
                1.4 * direction[0], 1.4 * direction[1], name,
                color=_INK, fontsize=0.8 * layout.font, ha='center',
                va='center')

    def _explain(self, survey: Survey, view: View, note: str, look: str) -> None:
        layout = self.layout
        width, height = layout.size
        middle = layout.middle / width
        handles = legend_handles(
            survey, view, grid_step(survey.size), 0.55 * layout.font, look)
        if handles:
            self._figure.legend(
                handles=handles, loc='center', ncols=len(handles), frameon=False,
                bbox_to_anchor=(middle, 0.68 * layout.legend_height / height), labelcolor=_INK,
                fontsize=0.9 * layout.font, handletextpad=0.5, columnspacing=1.6)
        # The directions stand to the left, and the same room is left free on the right.
        room = 2.0 * (layout.middle - layout.legend_height)
        self._figure.text(
            middle, 0.24 * layout.legend_height / height, note,
            fontsize=min(0.75 * layout.font, _LETTERS * room / max(len(note), 1)),
            color='#707070', ha='center', va='center')
