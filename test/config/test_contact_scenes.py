# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scenes with contact show what their comments say."""

from pathlib import Path

from cloth_sim_ros.sim.model.colliders import fields_with_colliders
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest

CONFIG = Path(__file__).resolve().parents[2] / 'config'
pytestmark = pytest.mark.long


@pytest.fixture
def opened():
    """Return a function that begins the run of a scene, and close them."""
    made = []

    def make(name, **changes):
        given = {**load_parameters(CONFIG / f'{name}.yaml'), **changes}
        names = {field.name for field in fields_with_colliders(given)}
        made.append(Simulation(Scene({
            name: value for name, value in given.items() if name in names})))
        return made[-1]

    yield make
    for simulation in made:
        simulation.close()


def depth(simulation):
    """Return how far the deepest node or middle of an edge is in a body [m]."""
    places = simulation.positions().astype(float)
    middles = [(places[1:] + places[:-1]) / 2.0, (places[:, 1:] + places[:, :-1]) / 2.0]
    return max(
        -body.distance(each.copy()).min() for body in simulation.colliders
        for each in (places, *middles))


def test_the_towel_over_bodies_comes_to_rest(opened):
    """A draped cloth would creep or tremble for ever, or bodies stick out of it."""
    simulation = opened('towel_over_bodies')
    simulation.advance(5.0)
    speeds = np.linalg.norm(simulation.velocities(), axis=-1)
    rms = float(np.sqrt(np.mean(speeds**2)))
    print(f'after 5 s nodes move by {1e3 * rms:.2g} mm/s (rms), the fastest by '
          f'{1e3 * speeds.max():.2g} mm/s')
    assert rms < 1e-3
    assert depth(simulation) < 0.0
    assert simulation.measure().max_strain < 0.05


def test_the_tablecloth_lies_on_its_table(opened):
    """It would slip off, or the rim stick out of it."""
    simulation = opened('tablecloth')
    simulation.advance(3.0)
    places = simulation.positions()
    # At the rim it bends upwards a little.
    on_top = np.hypot(places[..., 0], places[..., 1]) < 0.16
    np.testing.assert_allclose(places[on_top][:, 2], 0.75 + 0.005, atol=1e-3)
    assert places[..., 2].min() < 0.6
    assert depth(simulation) < 1e-3
    # Woven cloth lies around a disc by shearing: diagonals change, threads don't.
    threads = max(
        (np.linalg.norm(np.diff(places, axis=axis), axis=-1) / spacing).max() - 1.0
        for axis, spacing in zip((1, 0), simulation.scene.spacing))
    assert threads < 0.005
    assert simulation.measure().max_strain < 0.15


@pytest.mark.parametrize(('friction', 'is_lifted'), [(0.8, True), (0.0, False)])
def test_the_fingers_lift_by_friction_alone(opened, friction, is_lifted):
    """A towel would slip out of any gripper, or stick to one without friction."""
    simulation = opened('pinch', **{
        f'colliders.{finger}.friction': friction for finger in ('front', 'back')})
    simulation.advance(4.5)
    heights = simulation.positions()[..., 2]
    print(f'friction {friction:g}: the upper end of the towel is at {heights.max():.2f} m')
    if is_lifted:
        # No node is left on the table.
        assert heights.max() > 0.6 and heights.min() > 0.31
    else:
        assert heights.max() < 0.32


def test_the_towel_slides_over_the_edge(opened):
    """It would catch at the edge and stretch like rubber."""
    simulation = opened('over_an_edge')
    largest = 0.0
    for _ in range(22):
        simulation.advance(0.1)
        largest = max(largest, simulation.measure().max_strain)
    heights = simulation.positions()[..., 2]
    assert largest < 0.05
    # More of it hangs than lies.
    assert np.mean(heights < 0.3) > 0.5


def test_the_ball_carries_the_curtain_along_and_lets_it_go(opened):
    """It would pass through the cloth, or take it along for ever."""
    simulation = opened('ball_and_curtain')
    simulation.advance(1.5)
    carried = simulation.positions()
    assert carried[..., 1].max() > 0.3
    assert depth(simulation) < 1e-3
    simulation.advance(4.5)
    assert np.abs(simulation.positions()[..., 1]).max() < 0.25
