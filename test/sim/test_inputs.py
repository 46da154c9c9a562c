# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What can be done to a cloth: what is accepted does the same when it is applied again."""

from collections.abc import Callable
from collections.abc import Iterator
from dataclasses import fields
import math
from typing import Any
from typing import get_args

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import Release
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import TakeGrasp
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from given_inputs import GIVEN
from given_inputs import handle
from given_inputs import HANDLED
from hostile_values import HOSTILE
from hostile_values import hostile
import numpy as np
import pytest


class Accepted(InputListener):
    """Keeps what is accepted, and can refuse everything."""

    def __init__(self) -> None:
        self.inputs: list[tuple[Input, float]] = []
        self.refuses = False

    def check(self, given):
        if self.refuses:
            raise ClothSimError('no more')

    def accept(self, given, time):
        self.inputs.append((given, time))


@pytest.fixture
def make(context: Context) -> Iterator[Callable[[], Simulation]]:
    """Return a function that makes a cloth which each input can act on."""
    opened = []

    def start() -> Simulation:
        opened.append(Simulation(Scene(HANDLED), context=context))
        handle(opened[-1])
        opened[-1].listener = Accepted()
        return opened[-1]

    yield start
    for simulation in opened:
        simulation.close()


def look(simulation: Simulation) -> list[Any]:
    """Return all that inputs can change, to the bit."""
    return [
        simulation.steps, simulation.mode, simulation.positions().tobytes(),
        simulation.velocities().tobytes(), simulation.pinned_nodes().tobytes(),
        simulation.pushes, simulation.pin_moves, simulation.loads.wind, simulation.colliders,
        [(grasp.name, grasp.pose, grasp.nodes.tolist(), grasp.max_force)
         for grasp in simulation.grasps],
        [(path.move, path.origin) for path in simulation.grasp_paths],
        [(moved.name, moved.pose) for moved in simulation.moved_colliders]]


def test_each_input_is_tried_here():
    """An input that is new would be neither checked nor recorded."""
    assert set(GIVEN) == set(get_args(Input))


@pytest.mark.parametrize('kind', GIVEN, ids=lambda kind: kind.__name__)
def test_what_was_accepted_does_the_same_again(make, kind):
    """A run could not be made again from its recording."""
    first, again = make(), make()
    before = look(first)
    for given in GIVEN[kind](first):
        first.apply(given)
    assert before != look(first)
    assert all(type(given) is kind for given, _ in first.listener.inputs)
    for given, time in first.listener.inputs:
        assert time == again.time
        again.apply(given)
    assert again.listener.inputs == first.listener.inputs or kind.__name__ == 'ReplaceState'
    for steps in (0, 1, 20):
        for each in (first, again):
            each.step(steps)
        assert look(first) == look(again), steps


@pytest.mark.parametrize('kind', GIVEN, ids=lambda kind: kind.__name__)
def test_what_was_accepted_has_no_default_left(make, kind):
    """Another version, or a scene with other values, would take something else."""
    simulation = make()
    for given in GIVEN[kind](simulation):
        simulation.apply(given)
    for given, _ in simulation.listener.inputs:
        left = {each.name for each in fields(given) if getattr(given, each.name) is None}
        # A frame that is only moved keeps the orientation that it has.
        assert left <= {'orientation'}
        assert not isinstance(given, PushNodes) or not given.starts_now


@pytest.mark.parametrize('kind', GIVEN, ids=lambda kind: kind.__name__)
def test_bad_values_change_nothing(make, kind):
    """A program could lose a cloth, or have half an input applied."""
    simulation = make()
    good = {each.name: getattr(GIVEN[kind](simulation)[0], each.name) for each in fields(kind)}
    before, bad = look(simulation), []
    for name in good:
        for value in HOSTILE:
            given = kind(**{**good, name: hostile(value)})
            try:
                simulation.apply(given)
            except ClothSimError as error:
                assert str(error) and '\n' not in str(error)
                if look(simulation) != before or simulation.listener.inputs:
                    bad.append(f'{name}={value} changed something, refused')
            except Exception as error:
                bad.append(f'{name}={value}: {type(error).__name__} {error}'[:200])
            else:
                simulation.close()
                simulation = make()
    assert not bad, '\n'.join(bad)


@pytest.mark.parametrize('given', [None, 3, 'Pin', Pin, (1, 2), Push.checked(
    force=(0.0, 0.0, 1.0), start=0.0, duration=1.0)], ids=str)
def test_what_is_no_input_is_refused(make, given):
    """A program would end in an AttributeError."""
    simulation = make()
    with pytest.raises(ClothSimError, match='an input must be one of .*: give one'):
        simulation.apply(given)
    assert simulation.listener.inputs == []


@pytest.mark.parametrize('kind', GIVEN, ids=lambda kind: kind.__name__)
def test_a_listener_can_refuse_each_input(make, kind):
    """What cannot be recorded would be done all the same."""
    simulation = make()
    given, = GIVEN[kind](simulation)[:1]
    simulation.listener.refuses = True
    before = look(simulation)
    with pytest.raises(ClothSimError, match='no more'):
        simulation.apply(given)
    assert look(simulation) == before and simulation.listener.inputs == []


def test_a_push_begins_when_it_is_accepted(make):
    """One without a start would begin in the past, or at the next one's time."""
    simulation = make()
    now = simulation.time
    assert now > 0.0
    push = Push.checked(force=(0.0, 0.0, 1.0), start=0.5 * now, duration=0.1)
    assert simulation.apply(PushNodes(push, starts_now=True)).push.start == now
    with pytest.raises(ClothSimError, match='in the past, the time is .*: give a later one'):
        simulation.apply(PushNodes(push))
    with pytest.raises(ClothSimError, match='the start of a push must be from 0'):
        simulation.push((0.0, 0.0, 1.0), start=-math.inf, duration=0.1)


def test_nodes_of_a_grasp_move_with_it_alone(make):
    """A node would be at two places at once."""
    simulation = make()
    node = simulation.grasps[0].nodes[0].tolist()
    before = look(simulation)
    for move in (
            lambda: simulation.pin(*node), lambda: simulation.release(*node),
            lambda: simulation.move_pin(*node, (0.0, 0.0, 1.0)),
            lambda: simulation.grasp('other', (0.0, 0.0, 1.0), nodes=[node])):
        with pytest.raises(ClothSimError, match='(holds node|which is pinned)'):
            move()
    assert look(simulation) == before


def test_lost_grasps_are_heard_of_as_inputs(make):
    """A recording would not say why a cloth fell."""
    simulation = make()
    simulation.release_grasp('hand')
    simulation.apply(TakeGrasp(
        'weak', simulation.positions()[4, 4].astype(float), max_force=1e-3))
    simulation.step(10)
    assert simulation.listener.inputs[-1][0] == Release('weak', by_force=True)
    assert [grasp.name for grasp in simulation.grasps] == []


def test_the_mode_before_is_told(make):
    """A reader of a recording would not know from where a switch came."""
    simulation = make()
    assert simulation.apply(SetMode('constraint', 'nonsense')) == 'mass_spring'
    assert simulation.apply(SetMode('constraint')) == 'constraint'
    assert [given for given, _ in simulation.listener.inputs] == [
        SetMode('constraint', 'mass_spring'), SetMode('constraint', 'constraint')]


def test_numpy_values_are_accepted_as_plain_ones(make):
    """What is computed would be refused, or recorded as what no message holds."""
    simulation = make()
    simulation.apply(Pin(np.int64(4), np.uint8(4)))
    given, _ = simulation.listener.inputs[0]
    assert (type(given.row), type(given.col)) == (int, int)
