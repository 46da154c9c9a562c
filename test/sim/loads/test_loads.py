# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The loads as modes and observers see them."""

import math

from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.study.feature_costs import pass_list
import numpy as np
import pytest
from springs import SPRINGS

SMALL = {**SPRINGS, 'rows': 8, 'cols': 9, 'dt': 0.004}
AIR = {**SMALL, 'air.density': 1.225, 'air.wind': [2.0, 0.0, 1.0]}
# Set, and without effect where there is no air.
UNUSED = {**SMALL, 'air.drag': 2.0, 'air.friction': 0.5, 'air.wind': [5.0, 0.0, 0.0],
          'gusts.start': [0.0], 'gusts.duration': [1.0], 'gusts.wind': [1.0, 2.0, 3.0]}


@pytest.fixture
def simulate(context):
    """Return a function from scene values to a simulation, which ends with the test."""
    opened = []

    def start(values):
        opened.append(Simulation(Scene(values), context=context))
        return opened[-1]

    yield start
    for run in opened:
        run.close()


@pytest.fixture
def make(context):
    """Return a function from scene values to loads and a state."""
    parts = []

    def start(values):
        scene = Scene(values)
        layout = choose_layout(scene, context)
        state = State(layout, scene.start_positions(), scene.pinned_nodes())
        parts.extend((Loads(scene, layout, state), state))
        return parts[-2:]

    yield start
    for part in parts:
        part.delete()


@pytest.mark.parametrize('mode', ['mass_spring', 'constraint', 'adaptive'])
def test_without_air_nothing_of_it_is_there(context, simulate, mode):
    """A scene without air would pay for it, or move otherwise."""
    plain, unused = (
        pass_list({**values, 'mode': mode}, context=context) for values in (SMALL, UNUSED))
    assert plain == unused
    assert not any('air' in each['shader'] for each in plain['passes'])
    runs = [simulate({**values, 'mode': mode}) for values in (SMALL, UNUSED)]
    for run in runs:
        run.step(25)
    assert runs[0].snapshot().state_sha256 == runs[1].snapshot().state_sha256


def test_gravity_alone_is_quiet_for_good(make):
    """Watchers would look again and again at what can't change."""
    loads, state = make(SMALL)
    assert loads.quiet_until(1.0) == math.inf
    assert loads.forcing(state, 0.0, 0.1) is loads.still
    assert loads.foreseen(state, 0.0, 0.1, is_quiet=True) is loads.still


def test_air_is_quiet_while_it_holds(make):
    """A watcher would trust in air that has changed, or look at it in each substep."""
    loads, state = make(AIR)
    loads.begin_step(0.0, 0.004)
    assert loads.quiet_until(0.0) == 0.0
    first = loads.forcing(state, 0.0, 0.0005)
    until = loads.quiet_until(0.0)
    assert 0.0005 < until <= 0.004 + 1e-12
    assert loads.forcing(state, 0.0005, 0.001) is first
    assert loads.forcing(state, until, until + 0.0005) is not first


def test_a_push_ends_what_holds(make):
    """A push that begins between two looks of the air would come late."""
    loads, state = make(AIR)
    loads.begin_step(0.0, 0.004)
    push = Push.checked(force=(0.0, 0.0, 7.2), start=0.0005, duration=1.0)
    loads.pushes.add(push, 0.0)
    before = loads.forcing(state, 0.0, 0.0005)
    during = loads.forcing(state, 0.0005, 0.001)
    assert before.everywhere == loads.still.everywhere
    assert during.everywhere[2] > before.everywhere[2] + 1.0


def test_the_same_substep_has_the_same_air(make):
    """A solve that is made again would have other loads once the nodes have moved."""
    loads, state = make(AIR)
    loads.begin_step(0.0, 0.004)
    first = loads.forcing(state, 0.0, 0.004, 0.003)
    nodes = np.array([(3, 3), (0, 0)])
    air = loads.at_nodes(nodes)
    state.write(2.0 * state.read_positions(), state.read_velocities() + 1.0)
    assert loads.forcing(state, 0.0, 0.004, 0.003) is first
    np.testing.assert_array_equal(loads.at_nodes(nodes), air)


def test_repeated_substep_uses_the_current_pushes(make):
    """A push removed since would act, or one that was queried in between."""
    loads, state = make(SMALL)
    push = Push.checked(force=(0.0, 0.0, 7.2), start=0.0, duration=1.0)
    loads.pushes.add(push, 0.0)
    pushed = loads.forcing(state, 0.0, 0.004)
    assert loads.forcing(state, 0.0, 0.004) is pushed
    assert pushed.everywhere[2] > loads.still.everywhere[2] + 1.0
    loads.pushes.acting(2.0)
    assert loads.forcing(state, 0.0, 0.004).everywhere == pushed.everywhere
    loads.pushes.clear()
    assert loads.forcing(state, 0.0, 0.004).everywhere == loads.still.everywhere


def test_looking_on_does_not_change_a_run(simulate):
    """What a viewer asks for would decide where the cloth goes."""
    values = {**AIR, 'pushes.start': [0.01], 'pushes.duration': [0.03],
              'pushes.force': [0.0, 0.0, 1.0], 'pushes.center': [0.0, 0.0, 1.0],
              'pushes.radius': [0.4]}
    alone, watched = simulate(values), simulate(values)
    alone.step(30)
    for _ in range(30):
        watched.step()
        watched.snapshot()
        watched.snapshot(pin_forces=True)
        watched.measure()
    assert alone.snapshot().state_sha256 == watched.snapshot().state_sha256


def test_another_wind_blows_from_the_end_of_the_step(simulate):
    """A wind that is set would be lost, or outlive a reset."""
    run, other = simulate(AIR), simulate({**AIR, 'air.wind': [0.0, -6.0, 0.0]})
    run.set_wind((0.0, -6.0, 0.0))
    for each in (run, other):
        each.step(20)
    assert run.snapshot().state_sha256 == other.snapshot().state_sha256
    run.reset()
    assert run.loads.wind == (2.0, 0.0, 1.0)


def test_a_wind_without_air_is_refused(simulate):
    """Somebody would wait for a cloth to move that can't."""
    run = simulate(SMALL)
    with pytest.raises(ClothSimError, match='no wind in a scene without air: start it with air'):
        run.set_wind((1.0, 0.0, 0.0))


def test_a_bad_wind_changes_nothing(simulate):
    """A cloth would be lost to a number that is none."""
    run = simulate(AIR)
    with pytest.raises(ClothSimError, match='the wind must be 3 numbers'):
        run.set_wind((math.nan, 0.0, 0.0))
    assert run.loads.wind == (2.0, 0.0, 1.0)
