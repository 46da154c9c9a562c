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

"""The scheme `penalty`: where the stiffness and the substeps go, and what strain is left."""

from cloth_sim_ros.reference.adaptive_penalty import PenaltyAdaptiveReference
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.stability import safe_substep
from limit_scenes import paper_scene
from limit_scenes import springs
from limit_scenes import unit_scene
from measured_strain import strain_and_energy
import pytest


def test_substeps_are_stable_with_the_extra_stiffness():
    """The substep is longer than that of a cloth with k + k_l in all limited springs."""
    scene = unit_scene(12, 0.01, 20)
    cloth = PenaltyAdaptiveReference(scene)
    extra = []
    while cloth.time < 0.6:
        cloth.step()
        if cloth.extra_stiffness > 0.0:
            stiffer = Scene({**scene.values, **{
                f'stiffness.{family}': 5.0 + cloth.extra_stiffness
                for family in ('structural', 'shear')}})
            longest = cloth._next_length(9.81)
            assert 0.8 * safe_substep(stiffer) < longest <= safe_substep(stiffer) * (1.0 + 1e-9)
            extra.append(cloth.extra_stiffness)
    assert max(extra) > 50.0


def test_a_hanging_weight_stretches_its_spring_to_the_limit():
    """The force is not k s up to the limit and (k + k_l) beyond, or k_l does not settle."""
    cloth = PenaltyAdaptiveReference(Scene({
        'rows': 2, 'cols': 1, 'node_mass': 0.1, 'pins': ['top_left'], 'dt': 0.01,
        'start.pose': 'hanging', **springs(5.0, 0.05, 0.1)}))
    for _ in range(1500):
        cloth.velocities *= 0.97
        cloth.step()
    strain = cloth.max_strain()
    assert 0.1 < strain < 0.12
    pull = 5.0 * strain + cloth.extra_stiffness * (strain - 0.1)
    assert pull == pytest.approx(0.981, rel=0.02)


@pytest.mark.long
@pytest.mark.parametrize(('strength', 'strain'), [(5, 0.125), (20, 0.13)])
def test_paper_scene(strength, strain):
    """Strain or peak energy depend on the frame's dt, or the strain is above the table's."""
    results = [
        strain_and_energy(PenaltyAdaptiveReference(paper_scene(dt, strength)), 10.0)
        for dt in (0.01, 0.05)]
    assert max(result[0] for result in results) < strain
    assert results[0][1] == pytest.approx(results[1][1], rel=0.03)


@pytest.mark.long
@pytest.mark.parametrize(
    ('nodes', 'strength', 'strain'),
    [(12, 5, 0.125), (12, 20, 0.17), (32, 5, 0.12), (32, 20, 0.15)])
def test_unit_scene(nodes, strength, strain):
    """The strain of the soft cloth is above the table's."""
    results = [
        strain_and_energy(
            PenaltyAdaptiveReference(unit_scene(nodes, dt, strength)), 4.0 if nodes < 32 else 2.0)
        for dt in (0.01, 0.05)]
    assert max(result[0] for result in results) < strain
    assert results[0][1] == pytest.approx(results[1][1], rel=0.12)
