# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The outlines of the spheres that pushes act on."""

from collections.abc import Iterable

from cloth_sim_ros.sim.push import Push
import numpy as np

_POINTS = 97
# [m]: the outline of a larger sphere is nowhere near the cloth, and leaves float32.
_MOST = 1e12


def region_rings(pushes: Iterable[Push], axes: np.ndarray) -> list[np.ndarray]:
    """
    Return a circle for each of ``pushes`` that acts on a sphere whose outline can be in view.

    :param axes: of the camera that looks at it: right, up and towards it
    :return: (n, 3) each [m], the last point again the first
    """
    angles = np.linspace(0.0, 2.0 * np.pi, _POINTS)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1) @ axes[:2]
    return [
        np.array(push.center) + push.radius * circle for push in pushes
        if push.region != 'all' and push.radius < _MOST]
