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

"""A stretched cloth becomes a constrained one over a while."""

from cloth_sim_ros.sim.modes.hardening import Hardening
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.solver.edge_law import edge_law
import numpy as np
import pytest


def test_a_cloth_in_shape_is_held_at_once():
    """A run in mode constraint would begin with soft edges."""
    hardening = Hardening(0.3)
    hardening.see(0.0)
    assert hardening.hardness == 1.0
    # Only what is seen first counts: a push must not soften edges.
    hardening.see(9.0)
    assert hardening.hardness == 1.0


@pytest.mark.parametrize('speed', [1.0, float('inf'), float('nan')])
def test_a_stretched_cloth_hardens_in_time(speed):
    """It would be thrown together, or never be held."""
    hardening = Hardening(0.3)
    hardening.see(speed)
    seen = []
    for _ in range(40):
        seen.append(hardening.hardness)
        hardening.spend(0.01)
        hardening.see(speed)
    assert seen[0] == 0.0
    assert np.all(np.diff(seen) >= 0.0)
    assert seen[15] == pytest.approx(0.5)
    assert seen[31:] == [1.0] * 9


def test_no_time_holds_at_once():
    """People could not have the paper's method."""
    hardening = Hardening(0.0)
    hardening.see(100.0)
    assert hardening.hardness == 1.0


def test_a_new_state_counts_anew():
    """The next stretched state would be thrown together."""
    hardening = Hardening(0.3)
    hardening.see(0.0)
    hardening.forget()
    hardening.see(1.0)
    assert hardening.hardness == 0.0


def test_the_law_goes_from_springs_to_hard_edges():
    """Forces jump as it begins or ends."""
    scene = Scene({'stiffness.structural': 300.0, 'stiffness.shear': 0.0, 'node_mass': 0.01})
    values = {'hard': ('structural', 'shear'), 'springs': ()}
    hard = edge_law(scene, 0.001, **values)
    first, half, last = (
        edge_law(scene, 0.001, hardness=hardness, **values) for hardness in (0.0, 0.5, 1 - 1e-9))
    assert first.weights[0] == pytest.approx(0.001**2 * 300.0 / 0.01)
    assert first.pulls[0] == pytest.approx(0.001 * 300.0 / 0.01)
    assert half.weights[0] == pytest.approx(np.sqrt(first.weights[0] * hard.weights[0]))
    assert 0.0 < first.weights[1] < half.weights[1] < last.weights[1]
    assert last.weights == pytest.approx(hard.weights)
    assert last.pulls == pytest.approx(hard.pulls)
