# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""Where the panels of a picture go, what they have in common, and what is written around them."""

from collections.abc import Sequence
import math

from cloth_sim_ros.analysis.camera import Camera
from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.strain_scale import round_up
from cloth_sim_ros.analysis.strain_scale import StrainScale
from matplotlib.axes import Axes
from matplotlib.figure import Figure
import numpy as np

_MOST_COLUMNS = 3
_PANEL_WIDTH = 3.3    # [inch]
_BAR_WIDTH = 1.2
_TITLE_HEIGHT = 0.3
_WORDS_HEIGHT = 0.9
_CORNER = 0.65        # side of the corner that shows the directions
_ARROW = 0.3          # of the largest push, over the longest side of all cloths
_WITH_WORDS = 1.25    # room for an arrow and its words, over its length
_MARGIN = 0.05        # around all cloths, over the size of the view
_SLIMMEST = 2.0       # longer over shorter side of a panel
_GRID_LINES = 8       # across the longest side
_INK = '#303030'
_GRID = '#d5d5d5'


class Sheet:
    """
    A figure with one panel for each frame, all seen by one camera at one scale.

    :param frames: at least one
    """

    def __init__(self, frames: Sequence[Frame], camera: Camera) -> None:
        """Measure the frames and lay the panels out."""
        self._camera = camera
        points = np.concatenate([frame.positions.reshape(-1, 3) for frame in frames])
        self._low, self._high = points.min(axis=0), points.max(axis=0)
        self.arrow_length = _ARROW * float(np.max(self._high - self._low))
        arrows = [
            arrow for frame in frames
            for arrow in frame.push_arrows(_WITH_WORDS * self.arrow_length)]
        self._view = _view_of(camera.project(np.concatenate([points, *arrows]))[:, :2])
        self._figure, self.panels = self._lay_out(len(frames))

    def set_up(self, axes: Axes, time: float) -> None:
        """Set the view of a panel and write its time [s]."""
        (left, bottom), (right, top) = self._view
        axes.set_xlim(left, right)
        axes.set_ylim(bottom, top)
        axes.set_title(f't = {time:.2f} s', fontsize=11, color=_INK, pad=3)

    def draw_floor(self, axes: Axes) -> None:
        """Draw a level grid through the lowest point of all, which shows how the view lies."""
        step = self._grid_step()
        begin = np.floor(self._low / step) * step
        end = np.maximum(np.ceil(self._high / step) * step, begin + step)
        for along, across in ((0, 1), (1, 0)):
            for place in np.arange(begin[across], end[across] + step / 2, step):
                ends = np.full((2, 3), self._low[2])
                ends[:, across] = place
                ends[:, along] = begin[along], end[along]
                line = self._camera.project(ends)
                axes.plot(line[:, 0], line[:, 1], color=_GRID, linewidth=0.7, zorder=0)

    def _draw_directions(self) -> None:
        """Draw the directions x, y and z into the lower left corner."""
        width, height = self._figure.get_size_inches()
        axes = self._figure.add_axes((0.0, 0.0, _CORNER / width, _CORNER / height))
        axes.set_xlim(-1.5, 1.5)
        axes.set_ylim(-1.1, 1.9)
        axes.axis('off')
        for name, direction in zip('xyz', self._camera.project(np.eye(3))[:, :2]):
            axes.annotate('', direction, (0.0, 0.0), arrowprops={
                'arrowstyle': '->', 'color': _INK, 'shrinkA': 0.0, 'shrinkB': 0.0})
            axes.text(
                *(1.35 * direction), name, color=_INK, fontsize=9, ha='center', va='center')

    def finish(self, scale: StrainScale, title: str, note: str) -> Figure:
        """Add the colour bar and the words, and return the figure."""
        bar = self._figure.colorbar(
            scale.in_percent, ax=self.panels, shrink=0.8, pad=0.015, aspect=26,
            extend='max' if scale.is_exceeded else 'neither')
        bar.set_label(
            f'strain |l / L0 - 1| [%], largest shown {100.0 * scale.largest:.3g} %', color=_INK)
        bar.outline.set_linewidth(0.5)
        self._draw_directions()
        self._figure.suptitle(title, fontsize=12, color=_INK)
        self._figure.supxlabel(
            '; '.join(filter(None, (
                note, f'grid {self._grid_step():g} m', 'red: pinned', 'blue: pushes'))),
            fontsize=9, color=_INK)
        return self._figure

    def _grid_step(self) -> float:
        return round_up(float(np.max(self._high - self._low)) / _GRID_LINES)

    def _lay_out(self, count: int) -> tuple[Figure, list[Axes]]:
        columns = min(count, _MOST_COLUMNS)
        rows = math.ceil(count / columns)
        width, height = self._view[1] - self._view[0]
        panel_height = _PANEL_WIDTH * height / width + _TITLE_HEIGHT
        figure = Figure(
            figsize=(_PANEL_WIDTH * columns + _BAR_WIDTH, panel_height * rows + _WORDS_HEIGHT),
            layout='constrained')
        panels = list(np.atleast_1d(figure.subplots(rows, columns)).ravel())
        for axes in panels:
            axes.set_aspect('equal')
            axes.axis('off')
        return figure, panels[:count]


def _view_of(seen: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower left and the upper right of a view with all that is ``seen``."""
    low, high = seen.min(axis=0), seen.max(axis=0)
    middle, size = (low + high) / 2.0, high - low
    # A chain is thin, and a panel should not be.
    size = np.maximum(size, np.max(size) / _SLIMMEST) * (1.0 + 2.0 * _MARGIN)
    return middle - size / 2.0, middle + size / 2.0
