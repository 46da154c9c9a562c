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

"""The system of the implicit step as a sparse float64 matrix: the oracle of the solver's tests."""

from cloth_sim_ros.reference.springs import spring_sets
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse import diags
from scipy.sparse import identity
from scipy.sparse.linalg import spsolve


class ImplicitSystem:
    """
    (M + J^T diag(a) J) dv = b over the node mass, with identity rows for pinned nodes.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param acceleration: on every free node [m/s2], or (rows, cols, 3)
    """

    def __init__(
            self, scene: Scene, law: EdgeLaw, positions: np.ndarray, velocities: np.ndarray,
            acceleration: np.ndarray | tuple[float, float, float]) -> None:
        """Add up all edges."""
        self._shape = positions.shape
        x, v = positions.astype(float), velocities.astype(float)
        free = (~scene.pinned_nodes()).astype(float)
        nodes = np.arange(scene.node_count).reshape(free.shape)
        matrix = identity(3 * scene.node_count, format='csr')
        right = law.length * np.broadcast_to(np.asarray(acceleration, float), x.shape).ravel()
        for springs in spring_sets(scene):
            weight = law.weights[FAMILIES.index(springs.family)]
            pull = law.pulls[FAMILIES.index(springs.family)]
            both_free = np.prod(springs.ends(free), axis=0).ravel()
            factor = np.where(
                both_free, 1.0, law.pinned_weights[FAMILIES.index(springs.family)])
            first, second = springs.ends(x)
            length = np.linalg.norm(first - second, axis=-1)
            direction = ((first - second) / length[..., None]).reshape(-1, 3)
            rows = _jacobian(direction, *(ends.ravel() for ends in springs.ends(nodes)), x.size)
            matrix = matrix + rows.T @ diags(weight * factor) @ rows
            tension = pull * (length.ravel() - springs.rest_length) + weight * (rows @ v.ravel())
            right = right - rows.T @ (factor * tension)
        mask = np.repeat(free.ravel(), 3)
        self._matrix = (diags(mask) @ matrix @ diags(mask) + diags(1.0 - mask)).tocsc()
        self.right_side = (right * mask).reshape(self._shape)

    def times(self, vector: np.ndarray) -> np.ndarray:
        """Multiply (rows, cols, 3) ``vector`` by the matrix."""
        return (self._matrix @ vector.astype(float).ravel()).reshape(self._shape)

    def solve(self, right_side: np.ndarray | None = None) -> np.ndarray:
        """Return the solution for ``right_side``, by default that of the step."""
        right = self.right_side if right_side is None else right_side
        return spsolve(self._matrix, right.ravel()).reshape(self._shape)


def _jacobian(
        direction: np.ndarray, first: np.ndarray, second: np.ndarray, width: int) -> csr_matrix:
    rows = np.repeat(np.arange(len(direction)), 6).reshape(-1, 6)
    axes = np.arange(3)
    columns = np.hstack([3 * first[:, None] + axes, 3 * second[:, None] + axes])
    values = np.hstack([direction, -direction])
    return csr_matrix(
        (values.ravel(), (rows.ravel(), columns.ravel())), shape=(len(direction), width))


def relative_error(values: np.ndarray, expected: np.ndarray) -> float:
    """Return the norm of the difference over that of ``expected``."""
    return float(np.linalg.norm(values - expected) / np.linalg.norm(expected))
