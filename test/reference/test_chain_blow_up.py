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

"""How long a step a hanging chain stands, against the eigenvalues of its tensions."""

from cloth_sim_ros.reference.constraint import ConstraintOptions
from cloth_sim_ros.reference.constraint import ConstraintReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

GRAVITY = 9.81


def _limit(links):
    """Return 2 / sqrt(lambda_max(M^-1 K_geo)) of a chain of 1 m [s]."""
    stiffness = np.zeros((links + 1, links + 1))
    for edge in range(links):
        per_length = (links - edge) * GRAVITY * links
        stiffness[edge:edge + 2, edge:edge + 2] += per_length * np.array([[1, -1], [-1, 1]])
    return 2.0 / np.sqrt(np.linalg.eigvalsh(stiffness[1:, 1:])[-1])


def _strays(links, dt, newton_iterations=1):
    """Return how far a slightly disturbed chain goes in 1500 steps [m]."""
    cloth = ConstraintReference(
        Scene({'rows': links + 1, 'cols': 1, 'height': 1.0, 'node_mass': 1.0, 'dt': dt,
               'pins': ['top_left'], 'start.pose': 'hanging', 'stiffness.bend': 0.0,
               'damping.bend': 0.0}),
        ConstraintOptions(newton_iterations=newton_iterations, substeps=1))
    rest = cloth.positions.copy()
    random = np.random.default_rng(0)
    cloth.positions += 1e-5 * random.normal(size=rest.shape) * cloth.free[..., None]
    far = 0.0
    for _ in range(60):
        cloth.step(25)
        far = max(far, float(np.abs(cloth.positions - rest).max()))
        if not far < 0.1:
            break
    return far


@pytest.mark.parametrize('links', [10, 20])
def test_blow_up_of_a_hanging_chain(links):
    """One linear solve is stable up to another step than the geometric limit."""
    limit = _limit(links)
    below, above = _strays(links, 0.95 * limit), _strays(links, 1.05 * limit)
    print(f'measured: {links} links, 2/omega {limit:.5f} s, off {below:.1e} m, {above:.1e} m')
    assert below < 0.01
    assert above > 0.1


@pytest.mark.parametrize('links', [10, 20])
def test_a_second_solve_stands_longer_steps(links):
    """The second solve does not raise the limit by a third."""
    far = _strays(links, 4.0 / 3.0 * _limit(links), newton_iterations=2)
    print(f'measured: {links} links, two solves, at 4/3 of the limit off {far:.1e} m')
    assert far < 0.03
