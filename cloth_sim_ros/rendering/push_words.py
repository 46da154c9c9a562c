# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Write the force of each push beside the tip of its arrow."""

from collections.abc import Sequence

from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.view import View
from cloth_sim_ros.rendering.words import write_words
from cloth_sim_ros.sim.push import Push
import numpy as np

_COLOR = tuple(round(255 * part) for part in PUSH_COLOR)


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
        write_words(
            image, words, tuple(tip + away * ahead), size, color=_COLOR, is_bold=True)
