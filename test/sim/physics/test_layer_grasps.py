# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A grasp takes all layers within reach, or lifts the highest and leaves the others."""

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import SimulationRecorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.validation.layers import CELL
from cloth_sim_ros.validation.layers import THICKNESS
from crossings import crossings
from folded_towel import FOLD
from folded_towel import folded
from folded_towel import FOLDED_AT
from folded_towel import FOLDING
from folded_towel import HEM
from folded_towel import TOWEL
from made_again import assert_same
import numpy as np
import pytest


@pytest.mark.parametrize(('layers', 'lifted'), [('top', 1), ('all', 2)])
def test_grasp_lifts_one_layer_or_both(simulate, layers, lifted):
    """A robot could not open a folded towel, or not pick it up."""
    simulation = simulate(TOWEL)
    places = folded()
    simulation.set_state(places, np.zeros_like(places))
    simulation.advance(0.3)
    corner = simulation.positions()[0, 0].astype(float)
    grasp = simulation.grasp('hand', corner, radius=1.5 * CELL, layers=layers)
    rows = grasp.nodes[:, 0]
    assert (rows < FOLD).sum() == 4
    assert (rows > FOLD).sum() == (0 if layers == 'top' else 4)
    simulation.move_grasp('hand', corner + (-0.05, 0.0, 0.1), speed=0.2)
    for _ in range(60):
        simulation.advance(0.01)
        assert len(crossings(simulation.positions())) == 0
    heights = simulation.positions()[..., 2]
    print(f'{layers}: corners at {1e3 * heights[0, 0]:.1f} and {1e3 * heights[-1, 0]:.1f} mm')
    assert heights[0, 0] == pytest.approx(corner[2] + 0.1, abs=1e-5)
    assert (heights[-1, 0] > 0.09) == (lifted == 2)
    assert heights[-1, 0] < 1.1 * THICKNESS or lifted == 2


def test_all_is_what_a_grasp_takes_by_default(simulate):
    """Programs of before would hold other nodes."""
    simulation = simulate(TOWEL)
    places = folded()
    simulation.set_state(places, np.zeros_like(places))
    held = []
    for given in ({}, {'layers': 'all'}):
        held.append(simulation.grasp('hand', places[0, 3], count=5, **given).nodes.tolist())
        simulation.release_grasp('hand')
    assert held[0] == held[1] and len(held[0]) == 5
    by_count = simulation.grasp('hand', places[0, 3], count=5, layers='top').nodes
    assert len(by_count) == 5 and by_count[:, 0].max() < FOLD


def test_layer_that_is_held_is_not_reached_through(simulate):
    """A second hand would take the layer below what the first one holds."""
    simulation = simulate(TOWEL)
    places = folded()
    simulation.set_state(places, np.zeros_like(places))
    simulation.grasp('left', places[0, 0], radius=1.1 * CELL, layers='top')
    with pytest.raises(ClothSimError, match='no free node of the top layer within 0.02'):
        simulation.grasp('right', places[0, 0], radius=1.1 * CELL, layers='top')
    assert len(simulation.grasp('right', places[0, 0], radius=1.1 * CELL).nodes) == 3


@pytest.mark.parametrize('layers', ['both', '', 2, None, ['top'], float('nan')])
def test_other_words_are_refused(simulate, layers):
    """A mistyped word would take what nobody asked for."""
    simulation = simulate(TOWEL)
    with pytest.raises(ClothSimError, match='layers of grasp hand must be one of') as told:
        simulation.grasp('hand', (0.0, 0.0, 0.0), layers=layers)
    assert len(str(told.value).splitlines()) == 1
    assert not simulation.grasps
    with pytest.raises(ClothSimError, match='grasps.layers must be'):
        Scene({**TOWEL, 'grasps.start': [0.0], 'grasps.name': ['hand'],
               'grasps.position': [0.0, 0.0, 0.0], 'grasps.layers': [layers]})


def test_towel_is_folded_and_opened_to_the_bit(tmp_path):
    """A recorded run would take other layers when it is made again."""
    with Simulation(Scene(FOLDING)) as simulation:
        with SimulationRecorder(simulation, tmp_path) as recorder:
            recorder.advance(FOLDED_AT)
            opener = simulation.grasp('opener', HEM, radius=1.5 * CELL, layers='top')
            simulation.move_grasp('opener', (0.0, -0.05, 0.08), speed=0.3)
            recorder.advance(0.4)
        heights = simulation.positions()[..., 2]
    assert opener.nodes[:, 0].max() < FOLD
    middle = heights[[0, -1], FOLD]
    print(f'middles of the hems at {1e3 * middle[0]:.1f} and {1e3 * middle[1]:.1f} mm')
    assert middle[0] > 0.06 and middle[1] < 2.0 * THICKNESS
    assert_same(recorder.path)
