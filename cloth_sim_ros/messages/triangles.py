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

"""The faces of the lattice."""

import numpy as np


def triangles(rows: int, cols: int) -> np.ndarray:
    """
    Return the nodes of the two triangles of each cell, counted along the rows.

    Counter-clockwise seen from above while the cloth lies flat; none for a chain.

    :return: (2 (rows - 1) (cols - 1), 3) uint32
    """
    node = np.arange(rows * cols, dtype='<u4').reshape(rows, cols)
    corners = (
        node[:-1, :-1], node[1:, :-1], node[:-1, 1:],
        node[:-1, 1:], node[1:, :-1], node[1:, 1:])
    return np.stack(corners, axis=-1).reshape(-1, 3)
