# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A snapshot begun now and finished later is that of now, whatever was done in between."""

from collections.abc import Callable
from collections.abc import Iterator
from dataclasses import replace

from abandoned import abandon
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
from cloth_sim_ros.sim.snapshot import FLAG_TOUCHING
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np
import pytest
from springs import SPRINGS

_SCENE = {**SPRINGS, 'rows': 9, 'cols': 20, 'dt': 0.01, 'auto_substeps': True}
_SPHERE = {'region': 'sphere', 'center': (0.0, 0.0, 1.0), 'radius': 0.3}


@pytest.fixture
def simulate(context: Context) -> Iterator[Callable[..., Simulation]]:
    """Return a function that makes a cloth under way, pushed and with a pin that moves."""
    opened = []

    def make(**values: object) -> Simulation:
        opened.append(Simulation(Scene({**_SCENE, **values}), context=context))
        simulation = opened[-1]
        simulation.push((0.0, 0.0, 0.4), duration=0.5, **_SPHERE)
        simulation.move_pin(0, 0, (-0.4, 0.4, 1.2), speed=0.3)
        simulation.step(3)
        return simulation

    yield make
    for simulation in opened:
        simulation.close()


def same(first: Snapshot, second: Snapshot) -> bool:
    """Return whether two snapshots have the same bits, of nodes and of all numbers."""
    none = np.zeros(0)
    return first.records.tobytes() == second.records.tobytes() and (
        vars(replace(first, records=none)) | {'records': 0}
        == vars(replace(second, records=none)) | {'records': 0})


@pytest.mark.parametrize('mode', modes.AVAILABLE)
def test_it_has_the_bits_of_one_made_at_once(simulate, mode: str):
    """Positions, velocities, forces on flags, energies or the solver's numbers would be others."""
    simulation = simulate(mode=mode, **{'adaptive.threshold': 0.005})
    for _ in range(3):
        now = simulation.snapshot()
        assert same(simulation.begin_snapshot()(), now)
        simulation.step(5)
    assert now.flags.any() and now.elastic_energy > 0.0
    assert now.active_constraints > 0 or mode != 'adaptive'


@pytest.mark.parametrize('mode', modes.AVAILABLE)
def test_it_survives_whatever_comes_before_it_is_finished(simulate, mode: str):
    """A frame would show, or be stamped with, a moment that came after it."""
    simulation = simulate(mode=mode)
    other = next(name for name in modes.AVAILABLE if name != mode)
    for change in (
            lambda: simulation.step(5),
            lambda: simulation.set_mode(other),
            lambda: simulation.pin(4, 4),
            lambda: simulation.move_pin(4, 4, (0.1, 0.0, 1.1)),
            lambda: simulation.release(0, 0),
            lambda: simulation.push((0.0, 3.0, 0.0), duration=1.0),
            simulation.measure,
            simulation.snapshot,
            lambda: simulation.grasp('hand', (0.0, 0.0, 1.0), radius=0.5),
            lambda: simulation.set_state(
                simulation.positions() + np.float32(1.0), simulation.velocities()),
            simulation.reset,
            lambda: simulation.step(2)):
        now = simulation.snapshot()
        finish = simulation.begin_snapshot()
        change()
        simulation.engines.context.finish()
        assert same(finish(), now)
        assert same(finish(), now), 'and once more'


def test_an_abandoned_step_leaves_it_as_it_was(simulate):
    """A frame would show half a step."""
    simulation = simulate(mode='constraint')
    before, finish = simulation.snapshot(), simulation.begin_snapshot()
    abandon(simulation, steps=1, after=5)
    assert same(finish(), before)
    assert simulation.snapshot().records.tobytes() == before.records.tobytes()


def test_the_steps_after_it_have_the_same_bits(simulate):
    """A run whose frames are late could not be made again."""
    watched, alone = simulate(), simulate()
    for _ in range(5):
        finish = watched.begin_snapshot()
        watched.step(2)
        finish()
        alone.step(2)
    assert same(watched.snapshot(), alone.snapshot())


def test_a_second_one_leaves_the_first_as_it_was(simulate):
    """Of two frames that wait, both would show the later one."""
    simulation = simulate()
    known, finish = [], []
    for _ in range(3):
        known.append(simulation.snapshot())
        finish.append(simulation.begin_snapshot())
        simulation.step()
    for then, taken in reversed(list(zip(known, finish))):
        assert same(taken(), then)


def test_a_closed_cloth_has_finished_it(simulate):
    """What was read would be memory that belongs to something else."""
    simulation = simulate()
    now, finish = simulation.snapshot(), simulation.begin_snapshot()
    simulation.close()
    assert same(finish(), now)
    with Simulation(Scene(_SCENE)) as simulation:
        finish = simulation.begin_snapshot()
    assert finish().steps == 0, 'and its context has gone with it'


def test_what_touches_is_in_it(simulate):
    """Nodes that touch a collider would not be marked, or not be counted, in frames that wait."""
    simulation = simulate(**{
        'colliders.names': ['ball'], 'colliders.ball.size': [0.2],
        'colliders.ball.position': [0.0, 0.0, 0.85]})
    simulation.step(20)
    now, finish = simulation.snapshot(), simulation.begin_snapshot()
    assert now.sliding_nodes + now.sticking_nodes > 0 and np.any(now.flags & FLAG_TOUCHING)
    simulation.step()
    assert same(finish(), now)


def test_what_is_held_is_in_it(simulate):
    """A hand that lets go before the frame is sent would not be in it."""
    simulation = simulate()
    simulation.grasp('hand', (0.0, 0.0, 1.0), radius=0.3)
    now, finish = simulation.snapshot(), simulation.begin_snapshot()
    assert np.any(now.flags & FLAG_GRASPED)
    simulation.release_grasp('hand')
    simulation.step()
    assert same(finish(), now)


def test_a_cloth_of_several_slabs_is_whole(simulate, monkeypatch: pytest.MonkeyPatch):
    """Of a cloth too large for one storage block, only the first rows would be there."""
    monkeypatch.setattr('cloth_sim_ros.sim.device.observer._SLAB_BYTES', 44 * 20 * 16)
    simulation = simulate(rows=40)
    now, finish = simulation.snapshot(), simulation.begin_snapshot()
    simulation.step()
    assert same(finish(), now)


def test_only_what_is_begun_takes_memory(simulate):
    """A software device, which gains nothing by it, would have every record twice."""
    with take_inventory() as inventory:
        simulation = simulate()
        simulation.snapshot()
        before = inventory.buffer_bytes
        for _ in range(3):
            simulation.snapshot()
        assert inventory.buffer_bytes == before
        simulation.begin_snapshot()()
        once = inventory.buffer_bytes
        assert once >= before + simulation.snapshot().records.nbytes
        simulation.begin_snapshot()()
        assert inventory.buffer_bytes == once
        simulation.close()
        assert not inventory.buffers
