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

"""Structural and shear edges in eight colours: edges of one colour share no node."""

from cloth_sim_ros.reference.edges import Edges
from cloth_sim_ros.reference.limited_cloth import LIMITED
from cloth_sim_ros.sim.scene import Scene
import numpy as np


def coloured_edges(scene: Scene, edges: Edges) -> list[np.ndarray]:
    """
    Return the numbers of the limited edges, colour by colour.

    Edges along a row are told apart by the column of their first end, all others by its row.
    """
    row, col = np.divmod(edges.first, scene.cols)
    down, right = edges.second // scene.cols - row, edges.second % scene.cols - col
    limited = edges.of(LIMITED)
    colours = []
    for step in ((0, 1), (1, 0), (1, 1), (1, -1)):
        here = limited & (down == step[0]) & (right == step[1])
        along = col if step == (0, 1) else row
        for odd in (0, 1):
            colours.append(np.flatnonzero(here & (along % 2 == odd)))
    return colours
