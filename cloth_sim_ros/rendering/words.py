# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Write words into an image."""

from functools import lru_cache
from pathlib import Path

import matplotlib
import numpy as np
from PIL import Image
from PIL import ImageDraw
from PIL import ImageFont

INK = (48, 48, 48)
_HALO = (255, 255, 255)


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
    font = _font(size, is_bold)
    halo = max(1, round(size / 7))
    left, top, right, bottom = font.getbbox(text, anchor='mm', stroke_width=halo)
    across = float(np.clip(place[0], -left, max(width - right, -left)))
    down = float(np.clip(place[1], -top, max(height - bottom, -top)))
    # Only the part around the words is copied to and fro.
    x, y = max(int(across + left) - 1, 0), max(int(down + top) - 1, 0)
    part = image[y:int(down + bottom) + 2, x:int(across + right) + 2]
    canvas = Image.fromarray(np.ascontiguousarray(part))
    ImageDraw.Draw(canvas).text(
        (across - x, down - y), text, font=font, fill=color, anchor='mm', stroke_width=halo,
        stroke_fill=_HALO)
    part[:] = np.asarray(canvas)


@lru_cache
def _font(size: int, is_bold: bool) -> ImageFont.FreeTypeFont:
    # The font that matplotlib brings along and writes the rest with.
    name = 'DejaVuSans-Bold.ttf' if is_bold else 'DejaVuSans.ttf'
    return ImageFont.truetype(
        str(Path(matplotlib.get_data_path()) / 'fonts' / 'ttf' / name), size)
