# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Arrows of the pushes that act, in the scene of a page."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.view.drawing import diagonal
import numpy as np
import viser

COLOR = (20, 97, 224)
# Length of the largest push and, over that, radii of shaft and head and length of the head.
_LENGTH = 0.4  # [diagonal of the cloth]
_SHAFT, _HEAD, _HEAD_LENGTH = 0.016, 0.048, 0.17
# viser takes no empty list.
_NONE = np.zeros((1, 2, 3), np.float32)


class PushArrows:
    """An arrow for each push that acts."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Begin without pushes."""
        self._scene = server.scene
        self._shown: list[np.ndarray] = []

    def draw(self, frame: Frame) -> None:
        """Show the pushes that act in ``frame``."""
        length = _LENGTH * diagonal(frame)
        arrows = frame.push_arrows(length)
        if not arrows and not self._shown:
            return
        self._shown = arrows
        # Added anew each time, as their number changes.
        self._scene.add_arrows(
            '/pushes', np.array(arrows, np.float32) if arrows else _NONE, COLOR,
            shaft_radius=_SHAFT * length, head_radius=_HEAD * length,
            head_length=_HEAD_LENGTH * length, visible=bool(arrows))
