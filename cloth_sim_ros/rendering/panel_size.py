# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How large a panel is when nobody says."""

from cloth_sim_ros.rendering.camera import Camera
import numpy as np

_WIDTH = 540          # [pixel]
_SLIMMEST = 1.7       # longer over shorter side


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
