# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the arrows of the pushes stand."""

from collections.abc import Iterable

from cloth_sim_ros.sim.push import Push
import numpy as np


def push_arrows(
        pushes: Iterable[Push], time: float, nodes: np.ndarray,
        length: float) -> list[np.ndarray]:
    """
    Return tail and tip of an arrow for each push that acts at ``time`` [s].

    :param nodes: positions of nodes, (n, 3) [m]; their mean is the middle of the cloth
    :param length: of the arrow of the largest force [m]
    :return: (2, 3) float64 each [m]
    """
    active = [push for push in pushes if push.start <= time < push.end]
    forces = [np.array(push.force) for push in active]
    largest = max((np.linalg.norm(force) for force in forces), default=0.0)
    if largest == 0.0:
        return []
    arrows = []
    for push, force in zip(active, forces):
        tail = nodes.mean(axis=0, dtype=float) if push.region == 'all' else np.array(push.center)
        arrows.append(np.stack([tail, tail + force * (length / largest)]))
    return arrows
