# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the parts of a sheet are."""

from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.rendering.camera import Camera
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
