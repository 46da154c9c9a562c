# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours, sizes, light and lettering of all pictures, and the colours of strain."""

from collections.abc import Sequence
from functools import lru_cache
import math
from pathlib import Path

from cloth_sim_ros.analysis.strain_stops import STRAIN_STOPS
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.push import Push
import matplotlib
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.colors import Normalize
import numpy as np
from PIL import Image
from PIL import ImageDraw
from PIL import ImageFont

BACKGROUND = (1.0, 1.0, 1.0)
GRID_COLOR = (0.80, 0.80, 0.80)
SHADOW_COLOR = (0.91, 0.91, 0.915)
PIN_COLOR = (0.84, 0.10, 0.12)
GRASP_COLOR = (0.56, 0.20, 0.72)
PUSH_COLOR = (0.08, 0.38, 0.88)
LIMIT_COLOR = (0.16, 0.86, 0.84)    # stands out from strained and from slack cloth
UNKNOWN_COLOR = (0.72, 0.76, 0.82)  # of a cloth whose strain is not known

COLLIDER_COLOR = (0.70, 0.68, 0.65)  # as quiet as the floor, and darker
GROUND_COLOR = (0.955, 0.95, 0.94)

HEM_SHADE = 0.45      # how much darker the border of a cloth is
HIDDEN = 0.22         # opacity of a pin or an arrow behind the cloth
GRID_LINES = 8        # across the longest side


# Right, up and towards the camera.
DIRECTION = np.array([-0.45, 0.50, 0.74]) / np.linalg.norm([-0.45, 0.50, 0.74])
AMBIENT = 0.28
WRAP_POWER = 1.4      # of the light that reaches around the cloth: 1 to 2
GLOSS = 0.10
GLOSS_POWER = 24.0
BACK = 0.88

LIGHT_DEFINES = {
    'AMBIENT': AMBIENT, 'WRAP_POWER': WRAP_POWER, 'GLOSS': GLOSS, 'GLOSS_POWER': GLOSS_POWER,
    'BACK': BACK}


def set_light(program: RenderProgram, view: View) -> None:
    """Give the lamp's direction in the scene to ``program``, which is in use."""
    halfway = DIRECTION + np.array([0.0, 0.0, 1.0])
    program.set_vectors('light', DIRECTION @ view.axes)
    program.set_vectors('halfway', halfway / np.linalg.norm(halfway) @ view.axes)


# The colours of strain, and the range that they span.

_LEAST_STRAIN, _MOST = 1e-6, 1e3
_BINS = 2000
PALETTE_SIZE = 256
_COLORS = LinearSegmentedColormap.from_list(
    'strain', [tuple(part / 255 for part in color) for color in STRAIN_STOPS], N=PALETTE_SIZE)
_SHARE = 0.995        # of the nodes whose strain the colours tell apart
_LEAST = 1e-3
_STEPS = (1.0, 2.0, 5.0)


class StrainRange:
    """A histogram of strains, which gives percentiles without the strains being kept."""

    def __init__(self) -> None:
        """Begin with no strain."""
        self.largest = math.nan
        self._edges = np.geomspace(_LEAST_STRAIN, _MOST, _BINS)
        self._counts = np.zeros(_BINS + 1, np.int64)

    @property
    def is_known(self) -> bool:
        """Return whether some strain was given."""
        return not math.isnan(self.largest)

    def add(self, strain: np.ndarray) -> None:
        """Add the strains of a frame, of any shape; those that are not finite are ignored."""
        known = strain[np.isfinite(strain)]
        if known.size:
            self.largest = float(np.fmax(self.largest, known.max()))
            places = np.searchsorted(self._edges, known.ravel(), side='right')
            self._counts += np.bincount(places, minlength=_BINS + 1)

    def above(self, share: float) -> float:
        """Return the strain that ``share`` (0 to 1) of all strains stay below, to 1 percent."""
        total = np.cumsum(self._counts)
        place = int(np.searchsorted(total, share * total[-1]))
        return float(self._edges[place - 1]) if place else 0.0


class StrainScale:
    """
    Colours for all strains of a range alike.

    :param full: strain of the last colour; None fits it to the range
    :raises ClothSimError: when ``full`` is not above 0
    """

    def __init__(self, strains: StrainRange, full: float | None = None) -> None:
        """Fit the scale."""
        if full is not None and not 0.0 < full < math.inf:
            raise ClothSimError(
                f'the strain of the last colour must be above 0, got {full:g}: give 0.05 for 5 %')
        self.is_known = strains.is_known
        self.largest = strains.largest
        fitted = round_up(max(strains.above(_SHARE), _LEAST)) if strains.is_known else _LEAST
        self.full = fitted if full is None else full
        self.in_percent = ScalarMappable(Normalize(0.0, 100.0 * self.full), _COLORS)

    @property
    def is_exceeded(self) -> bool:
        """Return whether some node has more strain than the last colour stands for."""
        return self.largest > self.full

    @property
    def palette(self) -> np.ndarray:
        """Get red, green, blue, alpha from 0 to 1 of even steps, (PALETTE_SIZE, 4) float32."""
        return _COLORS(np.arange(PALETTE_SIZE)).astype(np.float32)

    def colors(self, strain: np.ndarray) -> np.ndarray:
        """Return red, green, blue, alpha from 0 to 1 of each strain, (..., 4)."""
        return _COLORS(strain / self.full)


def round_up(value: float) -> float:
    """Return the next of 1, 2 and 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return next((step * power for step in _STEPS if value <= step * power), 10.0 * power)


# Write words in an image, those at a push too.

INK = (48, 48, 48)
_HALO = (255, 255, 255)
_COLOR = (
    round(255 * PUSH_COLOR[0]), round(255 * PUSH_COLOR[1]), round(255 * PUSH_COLOR[2]))


def write_words(
        image: np.ndarray, text: str, place: tuple[float, float], size: int, *,
        color: tuple[int, int, int] = INK, is_bold: bool = False) -> None:
    """
    Write ``text`` into ``image`` with a light halo; what would be outside is moved in.

    :param image: (height, width, 3) uint8, changed in place
    :param place: of the middle of the text [pixel], right and down
    :param size: of the font [pixel]
    """
    height, width = image.shape[:2]
    left, top, right, bottom = _words_box(text, size, is_bold)
    across = float(np.clip(place[0], -left, max(width - right, -left)))
    down = float(np.clip(place[1], -top, max(height - bottom, -top)))
    # Only the part around the words is copied to and fro.
    x, y = max(int(across + left) - 1, 0), max(int(down + top) - 1, 0)
    part = image[y:int(down + bottom) + 2, x:int(across + right) + 2]
    canvas = Image.fromarray(np.ascontiguousarray(part))
    ImageDraw.Draw(canvas).text(
        (across - x, down - y), text, font=_font(size, is_bold), fill=color, anchor='mm',
        stroke_width=_halo_width(size), stroke_fill=_HALO)
    part[:] = np.asarray(canvas)


def _words_box(text: str, size: int, is_bold: bool) -> tuple[float, float, float, float]:
    """Return left, top, right and bottom of words with their halo, from their middle [pixel]."""
    return _font(size, is_bold).getbbox(text, anchor='mm', stroke_width=_halo_width(size))


def _halo_width(size: int) -> int:
    return max(1, round(size / 7))


@lru_cache
def _font(size: int, is_bold: bool) -> ImageFont.FreeTypeFont:
    # The font that matplotlib brings along and writes the rest with.
    name = 'DejaVuSans-Bold.ttf' if is_bold else 'DejaVuSans.ttf'
    return ImageFont.truetype(
        str(Path(matplotlib.get_data_path()) / 'fonts' / 'ttf' / name), size)


def write_forces(
        image: np.ndarray, pushes: Sequence[Push], arrows: Sequence[np.ndarray], view: View,
        size: int) -> None:
    """
    Write the forces of ``pushes`` into ``image``: beyond the tip, or else behind the tail.

    :param arrows: tail and tip of each push [m]
    :param size: of the font [pixel]
    """
    for push, arrow in zip(pushes, arrows):
        tail, tip = view.project(arrow)
        run = tip - tail
        length = float(np.linalg.norm(run))
        # A push towards the camera is a point in the view: its words go above it.
        ahead = run / length if length > 1.0 else np.array([0.0, -1.0])
        words = force_words(float(np.linalg.norm(push.force)))
        # Words are wider than high.
        away = size * (0.9 + 0.32 * len(words) * abs(ahead[0])) * ahead
        place = tip + away
        if not _is_inside(image, words, place, size) and _is_inside(
                image, words, tail - away, size):
            place = tail - away
        write_words(
            image, words, (place[0], place[1]), size, color=_COLOR, is_bold=True)


def force_words(force: float) -> str:
    """Return ``force`` [N] to three digits, without an exponent up to a million."""
    return f'{float(f"{force:.3g}"):g} N'


def _is_inside(image: np.ndarray, words: str, place: np.ndarray, size: int) -> bool:
    """Return whether bold ``words`` around ``place`` [pixel] are wholly in ``image``."""
    height, width = image.shape[:2]
    left, top, right, bottom = _words_box(words, size, is_bold=True)
    across, down = place
    return bool(
        across + left >= 0.0 and across + right <= width
        and down + top >= 0.0 and down + bottom <= height)
