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

"""The paper's scene under constraints, pushed with 5 g."""

from cloth_sim_ros.reference.constraint import ConstraintOptions
from cloth_sim_ros.reference.constraint import ConstraintReference
from limit_scenes import paper_scene
import numpy as np
import pytest


def _violation(dt, bend=0.0, **options):
    """Return the largest violation in 10 s and the mean and the most substeps."""
    cloth = ConstraintReference(paper_scene(dt, 5, bend=bend), ConstraintOptions(**options))
    largest, energy, substeps = 0.0, 0.0, []
    for _ in range(round(10.0 / dt)):
        cloth.step()
        largest = max(largest, cloth.violation())
        energy = max(energy, cloth.energies().kinetic)
        substeps.append(cloth.substeps)
    print(f'measured: dt {dt} bend {bend} {options} violation {largest:.2%} '
          f'kinetic energy {energy:.0f} J '
          f'substeps {np.mean(substeps):.2f}, at most {max(substeps)}')
    return largest


@pytest.mark.parametrize(('dt', 'violation'), [(0.005, 0.0045), (0.01, 0.018), (0.02, 0.07)])
def test_the_paper_method(dt, violation):
    """One solve without substeps does not lose (omega h)^2 / 2, four times as much at 2 h."""
    assert _violation(dt, newton_iterations=1, substeps=1) == pytest.approx(violation, rel=0.15)


@pytest.mark.parametrize('foresee_turn', [False, True])
@pytest.mark.parametrize(('dt', 'allowed'), [(0.02, 0.002), (0.05, 0.04)])
def test_two_solves_alone(dt, allowed, foresee_turn):
    """Two solves without substeps leave more than a second solve should."""
    assert _violation(dt, substeps=1, foresee_turn=foresee_turn) <= allowed


@pytest.mark.parametrize(('dt', 'allowed'), [(0.02, 0.002), (0.05, 0.02)])
@pytest.mark.parametrize('bend', [0.0, 1.0])
def test_two_solves_and_substeps(dt, allowed, bend):
    """The default lets edges stretch more than it may."""
    assert _violation(dt, bend) <= allowed
