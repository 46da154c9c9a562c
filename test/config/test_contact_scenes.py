# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The scenes with contact show what their comments say."""

from pathlib import Path

from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from crossings import crossings
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
        names = {field.name for field in all_fields(given)}
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


@pytest.mark.parametrize(('friction', 'is_lifted'), [(0.9, True), (0.0, False)])
def test_two_layers_are_lifted_by_friction(opened, friction, is_lifted):
    """The outer layers alone would be held, and the towel fall out of the fingers."""
    simulation = opened('pinch_with_fingers', **{
        f'colliders.{finger}.friction': friction for finger in ('front', 'back')})
    simulation.advance(3.3)
    closed = simulation.positions()
    between = (np.abs(closed - (0.0, -0.135, 0.185)) < (0.035, 0.006, 0.008)).all(axis=-1)
    rows = np.nonzero(between)[0]
    # The rows before the fold are the outer layer.
    fold = len(closed) // 2
    assert (rows < fold).sum() > 3 and (rows > fold).sum() > 3
    held = True
    for _ in range(27):
        simulation.advance(0.1)
        assert len(crossings(simulation.positions())) == 0
        held &= simulation.snapshot().surface_contact_held
    ends = simulation.positions()
    slip = np.linalg.norm((ends - closed - (0.0, -0.1, 0.35))[between], axis=-1).max()
    print(f'friction {friction:g}: nodes between the fingers have moved against them by '
          f'{1e3 * slip:.2g} mm')
    if is_lifted:
        assert held and ends[..., 2].min() > 0.3 and slip < 2e-3
    else:
        assert ends[..., 2].max() < 0.0


def test_ribbon_falls_into_a_heap(opened):
    """Layers of a heap would lie in each other, or tremble for ever."""
    simulation = opened('heap')
    for _ in range(80):
        simulation.advance(0.05)
        assert len(crossings(simulation.positions())) == 0
        assert simulation.snapshot().surface_contact_held
    speeds = np.linalg.norm(simulation.velocities(), axis=-1)
    height = simulation.positions()[..., 2].max()
    print(f'{1e3 * height:.0f} mm high, {simulation.snapshot().self_contacts} contacts, '
          f'{1e3 * np.sqrt(np.mean(speeds**2)):.2g} mm/s (rms)')
    assert speeds.max() < 1e-3 and 0.02 < height < 0.08


def test_sheets_lie_a_thickness_apart(opened):
    """Sheets of a stack would lie in each other, slide off or tremble."""
    simulation = opened('stack')
    held = True
    for _ in range(65):
        simulation.advance(0.1)
        held &= simulation.snapshot().surface_contact_held
    places = simulation.positions().astype(float)
    assert held and len(crossings(places, simulation.scene.cut_cells)) == 0
    sheets = places.reshape(4, 13, 13, 3)
    # The second one lies on the table, the others on it in their order.
    heights = sheets[[1, 0, 2, 3], 6, 6, 2] / simulation.scene['self_contact.thickness']
    speed = np.abs(simulation.velocities()).max()
    print(f'middles at {heights.round(3).tolist()} thicknesses, {1e3 * speed:.2g} mm/s at most')
    np.testing.assert_allclose(heights, [0.5, 1.5, 2.5, 3.5], atol=0.01)
    assert speed < 1e-3
