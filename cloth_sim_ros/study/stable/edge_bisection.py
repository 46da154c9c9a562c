# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Find where a cloth ceases to be stable, between a step that is and one that is not."""

from collections.abc import Callable
from dataclasses import dataclass
import math

_FACTOR = 2.0
_MOST_WIDENINGS = 8


@dataclass(frozen=True)
class Edge:
    """
    The longest step seen to be stable and the shortest seen not to be [s].

    :param stable: 0 where none was stable
    :param unstable: infinite where all were
    """

    stable: float
    unstable: float

    @property
    def middle(self) -> float:
        """Return the edge, the geometric mean of both [s]; 0 or infinite where there is none."""
        if self.stable == 0.0 or math.isinf(self.unstable):
            return self.stable and self.unstable
        return math.sqrt(self.stable * self.unstable)


def bisect_edge(
        is_stable: Callable[[float], bool], guess: float, *, width: float = 0.005,
        longest: float = math.inf) -> Edge:
    """
    Return the edge of ``is_stable``, a function of the step, which lies near ``guess`` [s].

    :param width: of what is left between both sides, over the edge
    :param longest: step that is tried [s]
    """
    stable, unstable = 0.0, math.inf
    step = min(guess / math.sqrt(_FACTOR), longest)
    for _ in range(_MOST_WIDENINGS):
        if is_stable(step):
            stable = step
            if math.isfinite(unstable) or step >= longest:
                break
            step = min(step * _FACTOR, longest)
        else:
            unstable = step
            if stable:
                break
            step /= _FACTOR
    while stable and math.isfinite(unstable) and unstable > (1.0 + width) * stable:
        middle = math.sqrt(stable * unstable)
        if is_stable(middle):
            stable = middle
        else:
            unstable = middle
    return Edge(stable, unstable)
