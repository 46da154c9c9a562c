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

"""The two forms of the linear system against each other and against dense algebra."""

from cloth_sim_ros.reference.constraint import ConstraintOptions
from cloth_sim_ros.reference.constraint import ConstraintReference
from cloth_sim_ros.reference.solve import solve_dual
from cloth_sim_ros.reference.solve import solve_primal
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

SCENE = {'rows': 5, 'cols': 6, 'width': 1.3, 'height': 0.9, 'dt': 0.01,
         'pins': ['top_left', 'top_right', '2,3'], 'damping.shear': 0.02}


def _random_cloth(solve, hard, newton_iterations=2, scene=SCENE):
    random = np.random.default_rng(3)
    cloth = ConstraintReference(
        Scene(scene), ConstraintOptions(
            hard=hard, newton_iterations=newton_iterations, substeps=1, solve=solve))
    cloth.positions += random.normal(0.0, 0.02, cloth.positions.shape)
    cloth.velocities += random.normal(0.0, 0.5, cloth.positions.shape) * cloth.free[..., None]
    cloth.move_pin(0, 0, [0.3, -0.1, 0.2])
    return cloth


@pytest.mark.parametrize('hard', [(), ('structural',), ('structural', 'shear', 'bend')])
def test_dual_is_primal(hard):
    """One of the two forms of the same step is wrong."""
    dual, primal = (_random_cloth(solve, hard) for solve in (solve_dual, solve_primal))
    for cloth in (dual, primal):
        cloth.step(5)
    assert np.abs(dual.velocities - primal.velocities).max() < 1e-9
    assert np.abs(dual.positions - primal.positions).max() < 1e-9
    assert np.abs(dual.tension - primal.tension).max() < 1e-9 * np.abs(dual.tension).max()
    assert np.abs(dual.reactions - primal.reactions).max() < 1e-9 * np.abs(dual.tension).max()


def _dense_step(cloth, delta=1e-3):
    """Return v+ of one linear step from dense matrices filled edge by edge."""
    scene, h = cloth.scene, cloth.dt
    positions, velocities = cloth.positions.reshape(-1, 3), cloth.velocities.reshape(-1, 3)
    inverse = cloth.free.ravel() / scene.node_mass
    rows, rights, compliances = [], [], []
    force = np.array(scene['gravity'])
    dx, dy = scene.spacing
    for family, down, right in (
            ('structural', 0, 1), ('structural', 1, 0), ('shear', 1, 1), ('shear', 1, -1),
            ('bend', 0, 2), ('bend', 2, 0)):
        for row in range(scene.rows):
            for col in range(scene.cols):
                other = row + down, col + right
                if not (other[0] < scene.rows and 0 <= other[1] < scene.cols):
                    continue
                i, j = row * scene.cols + col, other[0] * scene.cols + other[1]
                if inverse[i] + inverse[j] == 0.0:
                    continue
                d = positions[i] - positions[j]
                length = np.sqrt(d @ d)
                jacobian = np.zeros((len(positions), 3))
                jacobian[i], jacobian[j] = d / length, -d / length
                error = length - np.hypot(dx * right, dy * down)
                if family == 'bend':
                    k, damping = scene.stiffness('bend'), scene.damping('bend')
                    beta = h * k / (h * k + damping)
                    compliances.append(1.0 / (h**2 * k + h * damping))
                else:
                    beta = 1.0
                    compliances.append(delta * (inverse[i] + inverse[j]))
                rows.append(jacobian.ravel())
                rights.append(beta * error / h**2 + np.sum(
                    jacobian * (velocities / h + force * (inverse > 0.0)[:, None])))
    matrix = np.array(rows)
    weights = np.repeat(inverse, 3)
    tension = np.linalg.solve(
        matrix * weights @ matrix.T + np.diag(compliances), np.array(rights))
    applied = (force * (inverse > 0.0)[:, None]).ravel()
    return (velocities.ravel() + h * applied - h * weights * (matrix.T @ tension)).reshape(
        cloth.velocities.shape)


@pytest.mark.parametrize('solve', [solve_dual, solve_primal])
def test_the_linear_step_solves_the_printed_system(solve):
    """The step is not (J W J^T + E) lambda = beta C / h^2 + J (v / h + W F)."""
    cloth = _random_cloth(solve, ('structural', 'shear'), newton_iterations=1)
    expected = _dense_step(cloth)
    start = cloth.positions.copy()
    cloth.step()
    np.testing.assert_allclose(cloth.velocities, expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(cloth.positions, start + cloth.dt * expected, atol=1e-10)


@pytest.mark.parametrize('solve', [solve_dual, solve_primal])
@pytest.mark.parametrize('pins', ['all', 'none'])
def test_all_and_no_nodes_pinned(solve, pins):
    """A cloth that can't move, or is held nowhere, has no solvable system."""
    cloth = ConstraintReference(
        Scene({**SCENE, 'pins': [pins]}), ConstraintOptions(solve=solve))
    start = cloth.positions.copy()
    cloth.step(10)
    fall = 0.0 if pins == 'all' else 9.81 * 0.1 * 0.11 / 2.0
    np.testing.assert_allclose(cloth.positions, start - [0.0, 0.0, fall], atol=1e-12)
