# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


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
