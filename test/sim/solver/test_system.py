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

"""The solver's matrix and right side are those of the springs, added up in float64."""

from implicit_system import relative_error
import numpy as np
import pytest

SHAPES = [(1, 2), (1, 9), (9, 1), (2, 2), (2, 30), (30, 2), (5, 7), (13, 16), (17, 12)]
PINS = [['none'], ['top_left', 'top_right'], ['top_edge', '4,3'], ['all']]


@pytest.mark.parametrize('shape', SHAPES)
@pytest.mark.parametrize('hard', [False, True])
def test_matrix_in_any_shape(make_case, shape, hard):
    """An edge would be missing, counted twice, or of the wrong weight or direction."""
    rows, cols = shape
    case = make_case({'rows': rows, 'cols': cols, 'width': 0.7}, hard=hard)
    vector = case.random_vector(1)
    product = case.solver.multiply(vector)
    if case.free.any():
        assert relative_error(product, case.system.times(vector)) < 1e-6


@pytest.mark.parametrize('pins', PINS, ids=lambda pins: pins[0])
@pytest.mark.parametrize('hard', [False, True])
def test_matrix_with_any_pins(make_case, pins, hard):
    """An edge to a pinned node would weigh the wrong amount, or a pinned node would move."""
    case = make_case({'rows': 7, 'cols': 9, 'pins': pins}, hard=hard)
    vector = case.random_vector(1)
    product = case.solver.multiply(vector)
    assert np.all(product[~case.free[..., 0]] == 0.0)
    assert np.linalg.norm(product - case.free * case.system.times(vector)) \
        <= 1e-6 * np.linalg.norm(case.system.times(vector))


@pytest.mark.parametrize('hard', [False, True])
@pytest.mark.parametrize('choice', [
    {'loads': 'texture', 'block': 1}, {'loads': 'texture', 'block': 3},
    {'loads': 'storage', 'block': 1}, {'loads': 'storage', 'block': 4}])
def test_matrix_in_every_layout(make_case, choice, hard):
    """A device that suits another layout would solve another system."""
    case = make_case({'rows': 13, 'cols': 9, **choice}, hard=hard)
    vector = case.random_vector(1)
    assert relative_error(case.solver.multiply(vector), case.system.times(vector)) < 1e-6
    assert relative_error(case.solver.right_side(), case.system.right_side) < 1e-4


def test_matrix_is_symmetric_and_positive(make_case):
    """Conjugate gradients would not converge."""
    case = make_case({'rows': 13, 'cols': 10})
    u, w = case.random_vector(1), case.random_vector(2)
    au, aw = case.solver.multiply(u).astype(float), case.solver.multiply(w).astype(float)
    assert abs(np.sum(w * au) - np.sum(u * aw)) < 1e-6 * np.linalg.norm(au) * np.linalg.norm(w)
    # The mass alone gives u.u; the edges can only add to it.
    assert np.sum(u * au) > np.sum(u.astype(float)**2)


@pytest.mark.parametrize('shape', [(1, 9), (2, 2), (30, 2), (13, 16)])
@pytest.mark.parametrize('hard', [False, True])
def test_right_side(make_case, shape, hard):
    """The step would pull the wrong way, forget gravity or damping, or move a pinned node."""
    rows, cols = shape
    case = make_case({'rows': rows, 'cols': cols, 'height': 1.3}, hard=hard)
    right = case.solver.right_side()
    if case.free.any():
        assert relative_error(right, case.system.right_side) < 1e-5
    assert np.all(right[~case.free[..., 0]] == 0.0)
