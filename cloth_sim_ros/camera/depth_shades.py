# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Depth as colours, for people to look at."""

from matplotlib import colormaps
import numpy as np

_WHITE = 255


def depth_shades(depth: np.ndarray) -> np.ndarray:
    """
    Return colours of ``depth``, (height, width): the nearest pixel is bright, the farthest dark.

    :return: (height, width, 3) uint8; white where depth is not finite
    """
    is_there = np.isfinite(depth)
    near, far = (depth[is_there].min(), depth[is_there].max()) if is_there.any() else (0.0, 0.0)
    span = float(far) - float(near) or 1.0
    share = (float(far) - np.where(is_there, depth, far).astype(float)) / span
    shades = 255.0 * colormaps['viridis'](share)[..., :3]
    shades[~is_there] = _WHITE
    return shades.astype(np.uint8)
