# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Which moments of a recording a picture shows when nobody says which."""

from collections.abc import Iterable

from cloth_sim_ros.sim.push import Push
import numpy as np


def panel_times(begin: float, end: float, pushes: Iterable[Push], count: int) -> list[float]:
    """
    Return ``count`` times from ``begin`` to ``end`` [s], evenly apart but for the pushes.

    The time next to the middle of a push moves there, so that the push is seen; the first and
    the last stay, and a time moves once.
    """
    times = np.linspace(begin, end, count)
    free = set(range(1, count - 1))
    for push in pushes:
        middle = push.start + push.duration / 2
        if not free or not begin < middle < end:
            continue
        nearest = min(free, key=lambda panel: abs(times[panel] - middle))
        times[nearest] = middle
        free.remove(nearest)
    return sorted(times.tolist())
