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


"""The implicit step solved directly in float64: what the device's solution is held against."""

from cloth_sim_ros.reference.edges import edges_of
from cloth_sim_ros.reference.solve import solve_primal
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
import numpy as np


def direct_step(
        scene: Scene, law: EdgeLaw, positions: np.ndarray, velocities: np.ndarray) -> np.ndarray:
    """
    Return dv [m/s] of the step that ``law`` describes, (rows, cols, 3), by a sparse LU.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    """
    edges = edges_of(scene)
    x, v = (field.reshape(-1, 3).astype(float) for field in (positions, velocities))
    free = ~scene.pinned_nodes().ravel()
    kind = np.array([FAMILIES.index(family) for family in edges.family])
    weight, pull = np.array(law.weights)[kind], np.array(law.pulls)[kind]
    factor = np.where(
        free[edges.first] & free[edges.second], 1.0, np.array(law.pinned_weights)[kind])
    in_system = weight > 0.0
    jacobian = edges.jacobian(edges.directions(x), len(x))[in_system]
    extension = (edges.lengths(x) - edges.rest_length)[in_system]
    weight, pull, factor = weight[in_system], pull[in_system], factor[in_system]
    # Gravity first, and the edges' answer to where that leads.
    falling = law.length * free[:, None] * np.asarray(scene['gravity'])
    residual = (pull / weight * extension + jacobian @ (v + falling).ravel()) / law.length
    change, _ = solve_primal(
        jacobian, np.repeat(free.astype(float), 3), 1.0 / (weight * factor), residual, law.length)
    return (falling + change.reshape(-1, 3)).reshape(positions.shape)
