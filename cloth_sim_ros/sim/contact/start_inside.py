# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Warn of a cloth that starts inside a body, which pushes it out at once."""

import warnings

from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Depth [cells] from which to warn. Chosen: no scene of config/ starts inside a body, and a
# misplaced cloth is usually several cells deep.
_DEEP = 0.5


def warn_of_start_inside(scene: Scene) -> None:
    """Warn of the body in which a free node starts deepest, if by more than half a cell."""
    free = scene.start_positions()[scene.present_nodes & ~scene.pinned_nodes()]
    if not scene.colliders or not len(free):
        return
    distances = [body.distance(free) for body in scene.colliders]
    depths = [-found.min() for found in distances]
    deepest = int(np.argmax(depths))
    if depths[deepest] <= _DEEP * max(scene.spacing):
        return
    body, count = scene.colliders[deepest], np.count_nonzero(distances[deepest] < 0.0)
    warnings.warn(
        f'{count} nodes start inside {body.name}, up to {depths[deepest]:.3g} m deep, and are '
        'pushed out in the first step, which stretches the cloth: start it beside or above the '
        'body', stacklevel=3)
