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

"""What holds for all adaptive schemes: plain springs far from the limit, and momentum."""

from cloth_sim_ros.reference.adaptive_impulse import ImpulseAdaptiveReference
from cloth_sim_ros.reference.adaptive_paper import PaperAdaptiveReference
from cloth_sim_ros.reference.adaptive_penalty import PenaltyAdaptiveReference
from cloth_sim_ros.reference.limited_cloth import split_evenly
from cloth_sim_ros.reference.mass_spring import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

SCHEMES = (PaperAdaptiveReference, PenaltyAdaptiveReference, ImpulseAdaptiveReference)


@pytest.mark.parametrize('scheme', SCHEMES)
def test_far_from_the_limit_it_is_mass_spring(scheme):
    """The scheme changes a cloth that no limit touches."""
    scene = Scene({
        'rows': 6, 'cols': 5, 'dt': 0.004, 'start.jitter': 0.1, 'pushes.start': [0.05],
        'pushes.duration': [0.03], 'pushes.force': [0.0, 0.1, 0.5]})
    cloth = scheme(scene, limit=5.0)
    plain = MassSpringReference(scene)
    for steps in range(50):
        cloth.step()
        plain.step()
        assert not cloth.active.any()
        assert cloth.switched == 0.0
        assert cloth.substeps == plain.substeps
    np.testing.assert_allclose(cloth.positions, plain.positions, atol=1e-11)
    np.testing.assert_allclose(cloth.velocities, plain.velocities, atol=1e-9)


def _momenta(cloth):
    mass = cloth.scene.node_mass
    return (mass * cloth.velocities.sum(axis=(0, 1)),
            mass * np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1)))


@pytest.mark.parametrize('scheme', SCHEMES)
def test_momentum_at_the_limit(scheme):
    """What holds an edge does not act on both its ends alike, and along it."""
    cloth = scheme(Scene({
        'rows': 6, 'cols': 6, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0], 'dt': 0.002,
        'stiffness.structural': 5.0, 'stiffness.shear': 5.0, 'stiffness.bend': 0.5}))
    random = np.random.default_rng(5)
    cloth.velocities += random.normal(0.0, 1.0, cloth.positions.shape)
    cloth.velocities[..., 2] += 3.0 * cloth.positions[..., 0]
    before = _momenta(cloth)
    active = 0
    for _ in range(200):
        cloth.step()
        active += np.count_nonzero(cloth.active)
    assert active > 100
    after = _momenta(cloth)
    turned = np.abs(after[1] - before[1]).max() / np.linalg.norm(before[1])
    print(f'measured: {scheme.__name__} angular momentum changed by {turned:.1e}')
    assert np.abs(after[0] - before[0]).max() < 1e-11 * np.linalg.norm(before[0])
    assert turned < 1e-11


def test_even_parts():
    """The rest of a step is split into more parts than it needs, or into longer ones."""
    assert split_evenly(0.01, 0.0034) == pytest.approx(0.01 / 3)
    assert split_evenly(0.01, 0.005) == pytest.approx(0.005)
    assert split_evenly(0.01, 1.0) == 0.01
