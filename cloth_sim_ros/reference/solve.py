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

"""
The linear system of an implicit step, solved directly in its two equivalent forms.

Both find the tensions lambda and the velocity change dv = -h W J^T lambda with

    (J W J^T + E) lambda = r,    E = diag(compliance)

J has a row for each edge, W is the inverse mass of each coordinate (0 where pinned).
"""

from collections.abc import Callable

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

Solve = Callable[
    [sparse.csr_matrix, np.ndarray, np.ndarray, np.ndarray, float],
    tuple[np.ndarray, np.ndarray]]


def solve_dual(
        jacobian: sparse.csr_matrix, inverse_mass: np.ndarray, compliance: np.ndarray,
        residual: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """
    Return dv and lambda from the system as it stands: one unknown for each edge.

    :param inverse_mass: of each coordinate [1/kg]
    :param compliance: of each edge, above 0 [1/kg]
    :param residual: r [m/s2]
    :param h: length of the step [s]
    """
    matrix = jacobian @ sparse.diags(inverse_mass) @ jacobian.T + sparse.diags(compliance)
    tension = splu(matrix.tocsc()).solve(residual)
    return -h * inverse_mass * (jacobian.T @ tension), tension


def solve_primal(
        jacobian: sparse.csr_matrix, inverse_mass: np.ndarray, compliance: np.ndarray,
        residual: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the same from (M + J^T a J) dv = -h J^T a r, a = 1 / E: three unknowns a free node.

    lambda then follows edge by edge: lambda = a (r + J dv / h).
    """
    free = inverse_mass > 0.0
    moved = jacobian[:, free]
    weight = 1.0 / compliance
    matrix = sparse.diags(1.0 / inverse_mass[free]) + moved.T @ sparse.diags(weight) @ moved
    change = np.zeros_like(inverse_mass)
    change[free] = splu(matrix.tocsc()).solve(-h * (moved.T @ (weight * residual)))
    return change, weight * (residual + jacobian @ change / h)
