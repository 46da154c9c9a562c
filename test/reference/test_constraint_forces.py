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

"""Momentum, tensions and the forces at the pins."""

from cloth_sim_ros.reference.constraint import ConstraintOptions
from cloth_sim_ros.reference.constraint import ConstraintReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

GRAVITY = 9.81


def _hanging(options=None, **values):
    """Return a cloth that has come to rest in air."""
    cloth = ConstraintReference(Scene({
        'start.pose': 'hanging', 'pins': ['top_edge'], 'dt': 0.01, 'areal_density': 0.2,
        **values}), options)
    for _ in range(500):
        cloth.velocities *= 0.95
        cloth.step()
    return cloth


def test_tensions_of_a_chain_are_the_weight_below():
    """The tension of an edge is not the weight it carries."""
    cloth = _hanging(rows=21, cols=1, **{'stiffness.bend': 0.0, 'damping.bend': 0.0})
    below = np.arange(20, 0, -1) * cloth.scene.node_mass * GRAVITY
    np.testing.assert_allclose(cloth.tension, below, rtol=1e-6)


def test_regularisation_at_rest():
    """With one solve, an edge at rest is not longer by h^2 delta (w_i + w_j) lambda."""
    cloth = _hanging(
        ConstraintOptions(newton_iterations=1, substeps=1, delta=1e-3), rows=21, cols=1,
        **{'stiffness.bend': 0.0, 'damping.bend': 0.0})
    below = np.arange(20, 0, -1) * cloth.scene.node_mass * GRAVITY
    ends = np.where(np.arange(20) == 0, 1.0, 2.0) / cloth.scene.node_mass
    longer = cloth.edges.lengths(cloth.positions.reshape(-1, 3)) - cloth.edges.rest_length
    np.testing.assert_allclose(longer, 0.01**2 * 1e-3 * ends * below, rtol=1e-4)


def test_tensions_of_a_strip_are_the_weight_below():
    """The vertical pull of the edges between two rows is not the weight below them."""
    cloth = _hanging(rows=15, cols=4, width=0.3)
    edges, positions = cloth.edges, cloth.positions.reshape(-1, 3)
    pull = cloth.tension * edges.directions(positions)[:, 2]
    for row in range(14):
        crossing = (edges.first // 4 <= row) & (edges.second // 4 > row)
        below = 4 * (14 - row) * cloth.scene.node_mass * GRAVITY
        assert pull[crossing].sum() == pytest.approx(below, rel=1e-4)


@pytest.mark.parametrize('pins', [['top_edge'], ['top_left', 'top_right'], ['top_left']])
def test_pin_reactions_are_the_weight(pins):
    """The pins do not hold the cloth's weight, their own nodes' with it."""
    cloth = _hanging(rows=6, cols=6, pins=pins)
    weight = 36 * cloth.scene.node_mass * GRAVITY
    total = cloth.reactions.sum(axis=(0, 1))
    np.testing.assert_allclose(total, [0.0, 0.0, weight], atol=1e-3 * weight)
    assert np.all(cloth.reactions[cloth.free] == 0.0)


def _momenta(cloth):
    mass = cloth.scene.node_mass
    return (mass * cloth.velocities.sum(axis=(0, 1)),
            mass * np.cross(cloth.positions, cloth.velocities).sum(axis=(0, 1)))


@pytest.mark.parametrize('newton_iterations', [1, 2])
def test_momentum_of_a_tumbling_cloth(newton_iterations):
    """A tension does not pull both its ends alike; or, with one solve, off its line."""
    cloth = ConstraintReference(
        Scene({'rows': 7, 'cols': 6, 'pins': ['none'], 'gravity': [0.0, 0.0, 0.0],
               'dt': 0.005}),
        ConstraintOptions(newton_iterations=newton_iterations, substeps=1))
    random = np.random.default_rng(4)
    cloth.velocities += random.normal(0.0, 0.3, cloth.positions.shape)
    cloth.velocities[..., 2] += 2.0 * cloth.positions[..., 0]
    before = _momenta(cloth)
    cloth.step(200)
    after = _momenta(cloth)
    scale = [np.linalg.norm(momentum) for momentum in before]
    assert np.abs(after[0] - before[0]).max() < 1e-11 * scale[0]
    turned = np.abs(after[1] - before[1]).max() / scale[1]
    print(f'measured: newton {newton_iterations} angular momentum lost {turned:.1e}')
    # The second solve pulls along edges that the first has turned, by what it left to do.
    assert turned < (1e-11 if newton_iterations == 1 else 1e-3)


def test_reactions_balance_the_momentum():
    """With moving pins, pushes and substeps: what the pins give is not what the cloth gets."""
    scene = Scene({
        'rows': 6, 'cols': 7, 'dt': 0.02, 'pins': ['top_left', 'top_right', '3,2'],
        'pushes.start': [0.05], 'pushes.duration': [0.07], 'pushes.force': [0.3, 0.2, 5.0],
        'pushes.center': [0.0, 0.0, 1.0], 'pushes.radius': [0.4]})
    cloth = ConstraintReference(scene)
    weight = 42 * scene.node_mass * np.array([0.0, 0.0, -GRAVITY])
    given = np.zeros(3)
    most = 0
    for step in range(15):
        for pin in ((0, 0), (0, 6)):
            cloth.move_pin(*pin, [0.2 * np.sin(step), 0.0, 0.4 * np.cos(3 * step)])
        cloth.step()
        most = max(most, cloth.substeps)
        given += cloth.dt * (cloth.reactions.sum(axis=(0, 1)) + weight)
    pushed = 0.07 * np.array([0.3, 0.2, 5.0])
    np.testing.assert_allclose(_momenta(cloth)[0], given + pushed, atol=1e-10)
    assert most > 1
