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

"""The scheme `impulse`: one edge at its limit, and what strain is left in a cloth."""

from cloth_sim_ros.reference.adaptive_impulse import ImpulseAdaptiveReference
from cloth_sim_ros.sim.scene import Scene
from limit_scenes import paper_scene
from limit_scenes import springs
from limit_scenes import unit_scene
from measured_strain import strain_and_energy
import numpy as np
import pytest


def _hanging(**values):
    return ImpulseAdaptiveReference(Scene({
        'rows': 2, 'cols': 1, 'node_mass': 0.1, 'pins': ['top_left'], 'dt': 0.01,
        'start.pose': 'hanging', **springs(5.0, 0.05, 0.1), **values}))


def test_a_hanging_weight_rests_at_the_limit():
    """The edge is not held at its limit by what its spring lacks of the weight."""
    cloth = _hanging()
    for _ in range(500):
        cloth.velocities *= 0.97
        cloth.step()
    assert cloth.active.all()
    tension = cloth.tension[0]
    assert tension == pytest.approx(0.981 - 5.0 * 0.1, rel=1e-3)
    # The compliance lets go of 0.03 of what the tension moves the weight in a substep.
    assert cloth.substeps == 1
    beyond = 0.03 * tension * cloth.dt**2 / 0.1
    assert cloth.max_strain() == pytest.approx(0.1 + beyond, rel=1e-6)


@pytest.mark.parametrize('side', [1.0, -1.0])
def test_the_limit_is_one_sided(side):
    """An edge at its limit is held back from returning, or is pulled to its rest length."""
    cloth = _hanging(gravity=[0.0, 0.0, 0.0])
    cloth.velocities[1, 0] = [0.0, 0.0, -20.0 * side]
    cloth.step()
    # Of the overshoot to come, 0.1, the compliance leaves 0.03 / 1.03.
    assert cloth.max_strain() == pytest.approx(0.1 + 0.1 * 0.03 / 1.03, abs=5e-5)
    assert np.sign(cloth.tension[0]) == side
    cloth.step(4)
    assert cloth.tension[0] == 0.0
    # The spring alone brings it back, 5 N/m x 0.1 m on 0.1 kg for four steps, besides what the
    # compliance had left to be taken back within a step.
    returning = side * cloth.velocities[1, 0, 2]
    assert 0.0 < returning < 5.0 * 0.04 + 0.1 * 0.03 / 1.03 / 0.01


@pytest.mark.long
@pytest.mark.parametrize(
    ('strength', 'sweeps', 'strain'),
    [(5, 2, 0.115), (20, 2, 0.127), (5, 4, 0.11), (20, 4, 0.125)])
def test_paper_scene(strength, sweeps, strain):
    """Strain or peak energy depend on the frame's dt, or the strain is above the table's."""
    results = [
        strain_and_energy(
            ImpulseAdaptiveReference(paper_scene(dt, strength), sweeps=sweeps), 10.0)
        for dt in (0.01, 0.05)]
    assert max(result[0] for result in results) < strain
    assert max(result[2] for result in results) < 0.045
    assert results[0][1] == pytest.approx(results[1][1], rel=0.1)


@pytest.mark.long
@pytest.mark.parametrize(
    ('nodes', 'strength', 'strain'),
    [(12, 5, 0.12), (12, 20, 0.125), (32, 5, 0.12), (32, 20, 0.13)])
def test_unit_scene(nodes, strength, strain):
    """The strain of the soft cloth is above the table's."""
    results = [
        strain_and_energy(
            ImpulseAdaptiveReference(unit_scene(nodes, dt, strength)), 4.0 if nodes < 32 else 2.0)
        for dt in (0.01, 0.05)]
    assert max(result[0] for result in results) < strain
    assert results[0][1] == pytest.approx(results[1][1], rel=0.12)
