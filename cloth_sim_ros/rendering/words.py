# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Write words in an image, those at a push too."""

from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path

from cloth_sim_ros.rendering.camera import View
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.sim.push import Push
import matplotlib
import numpy as np
from PIL import Image
from PIL import ImageDraw
from PIL import ImageFont

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


def write_forces(
        image: np.ndarray, pushes: Sequence[Push], arrows: Sequence[np.ndarray], view: View,
        size: int) -> None:
    """
    Write the forces of ``pushes`` into ``image``.

    :param arrows: tail and tip of each push [m]
    :param size: of the font [pixel]
    """
    for push, arrow in zip(pushes, arrows):
        tail, tip = view.project(arrow)
        run = tip - tail
        length = float(np.linalg.norm(run))
        # A push towards the camera is a point in the view: its words go above it.
        ahead = run / length if length > 1.0 else np.array([0.0, -1.0])
        words = f'{np.linalg.norm(push.force):.3g} N'
        # Words are wider than high.
        away = size * (0.9 + 0.32 * len(words) * abs(ahead[0]))
        place = tip + away * ahead
        write_words(
            image, words, (place[0], place[1]), size, color=_COLOR, is_bold=True)
