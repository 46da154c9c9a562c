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

"""Read the tensions that shaders keep four a cell, and put each where its edge starts."""

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.layout import Layout
import numpy as np

# As shaders/include/edges.glsl numbers the edges of a cell.
_ROW, _COLUMN, _DIAGONAL, _CROSSING = range(4)


def read_held_tension(tensions: Buffer, layout: Layout) -> np.ndarray:
    """Return the tension of every edge [N], (rows, cols, 6) float32 as in Snapshot."""
    stored = np.empty((layout.stored, 4), dtype=np.float32)
    tensions.read_into(stored)
    cells = layout.load(stored)
    held = np.zeros((layout.rows, layout.cols, len(EDGE_KINDS)), dtype=np.float32)
    held[..., :3] = cells[..., (_ROW, _COLUMN, _DIAGONAL)]
    # A cell's crossing edge starts at its second corner.
    held[:, 1:, 3] = cells[:, :-1, _CROSSING]
    return held
