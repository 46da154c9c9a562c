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


"""Find the node at a point."""

from collections.abc import Sequence
import math

from cloth_sim_ros.sim.errors import ClothSimError
import numpy as np


def nearest(
        positions: np.ndarray, point: Sequence[float],
        pinned: np.ndarray | None = None) -> tuple[int, int]:
    """
    Return row and col of the node nearest to ``point`` [m].

    :param positions: (rows, cols, 3) [m]
    :param pinned: (rows, cols) bool, to look among these nodes alone
    :raises ClothSimError: when the point is none, or no node is pinned
    """
    if len(point) != 3 or not all(math.isfinite(part) for part in point):
        raise ClothSimError(f'a point needs 3 finite numbers [m], got {tuple(point)}')
    away = positions - np.array(point, dtype=np.float32)
    squares = np.einsum('rci,rci->rc', away, away)
    if pinned is not None:
        if not pinned.any():
            raise ClothSimError('the cloth has no pin that is near to the point: pin a node first')
        squares = np.where(pinned, squares, np.inf)
    row, col = np.unravel_index(int(np.argmin(squares)), squares.shape)
    return int(row), int(col)
