# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A simulation keeps its time, its state and its promises."""

from collections.abc import Iterator

from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import Input
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.inputs import MovePin
from cloth_sim_ros.sim.inputs import Pin
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.inputs import ReplaceState
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.inputs import Unpin
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from springs import SPRINGS

_SMALL = {**SPRINGS, 'rows': 5, 'cols': 7, 'dt': 0.004}


@pytest.fixture
def simulation() -> Iterator[Simulation]:
    """Give a small cloth at its start."""
    simulation = Simulation(Scene(_SMALL))
    yield simulation
    simulation.close()


def test_time_is_steps_of_dt(simulation: Simulation):
    """The simulated clock would drift from the steps made."""
    simulation.step(3)
    assert simulation.steps == 3
    assert simulation.time == 3 * 0.004
    assert simulation.snapshot().time == simulation.time


def test_advance_carries_over_what_is_no_whole_step(simulation: Simulation):
    """With frames that are no multiple of dt the clock would fall behind."""
    made = [simulation.advance(0.01) for _ in range(200)]
    assert set(made) == {2, 3}
    assert sum(made) == 500
    assert simulation.time == pytest.approx(2.0)


@pytest.mark.parametrize('seconds', [-1.0, float('nan'), float('inf')])
def test_time_does_not_go_back(simulation: Simulation, seconds: float):
    """A bad duration would hang the node or corrupt its clock."""
    with pytest.raises(ClothSimError, match='cannot advance by'):
        simulation.advance(seconds)
    assert simulation.steps == 0


def test_goes_on_from_the_middle_of_a_run():
    """A run could not continue from its recorded state, or pushes would act twice."""
    timed = {
        **_SMALL, 'pushes.start': (0.0, 0.1), 'pushes.duration': (0.05, 0.1),
        'pushes.force': (0.0, 0.0, 1.0, 0.5, 0.0, 0.0), 'pin_moves.start': (0.01, 0.09),
        'pin_moves.node': ('top_left', 'top_left'), 'pin_moves.speed': (10.0, 1.0),
        'pin_moves.target': (-0.45, 0.5, 1.0, -0.4, 0.5, 1.0)}
    first, second = (Simulation(Scene(timed)) for _ in range(2))
    first.pin(3, 3)
    first.step(20)
    there = first.snapshot()
    second.go_on_from(
        20, there.positions, there.velocities, pinned=first.pinned_nodes(),
        pushes=[applied.push for applied in first.pushes])
    assert (second.time, second.pushes) == (first.time, first.pushes)
    for steps in (1, 9, 20):
        first.step(steps)
        second.step(steps)
        assert second.snapshot().records.tobytes() == first.snapshot().records.tobytes()
    for simulation in (first, second):
        simulation.close()


def test_goes_on_from_numbers_only(simulation: Simulation):
    """A state that is none would be stepped, and the cloth be lost."""
    there = simulation.snapshot()
    with pytest.raises(ClothSimError, match='velocities must be'):
        simulation.go_on_from(
            3, there.positions, there.velocities[:, 1:], pinned=simulation.pinned_nodes())
    assert simulation.snapshot().records.tobytes() == there.records.tobytes()


def test_reset_is_the_start_again(simulation: Simulation):
    """A second run would differ from the first."""
    start = simulation.snapshot()
    simulation.push((0.0, 0.0, 1.0), duration=1.0)
    simulation.pin(4, 4)
    simulation.step(20)
    first_run_moved = simulation.snapshot()
    assert first_run_moved.state_sha256 != start.state_sha256
    simulation.reset()
    again = simulation.snapshot()
    assert again.state_sha256 == start.state_sha256
    assert (again.time, again.steps, simulation.pushes) == (0.0, 0, ())
    assert np.array_equal(simulation.pinned_nodes(), simulation.scene.pinned_nodes())


def test_forces_are_there_when_asked_for(simulation: Simulation):
    """Every look would pay for what few need, or the few would not get it."""
    simulation.pin(4, 4)
    simulation.step(5)
    plain, pins, every = (
        simulation.snapshot(), simulation.snapshot(pin_forces=True),
        simulation.snapshot(tension=True))
    assert (plain.tension, plain.pin_forces, pins.tension) == (None, None, None)
    assert (every.tension.shape, every.tension.dtype) == ((5, 7, 6), np.float32)
    assert every.pin_forces.nodes.tolist() == [[0, 0], [0, 6], [4, 4]]
    assert np.array_equal(every.pin_forces.forces, pins.pin_forces.forces)
    assert plain.state_sha256 == every.state_sha256


def test_pins_hold_and_let_go(simulation: Simulation):
    """A held node would creep, or a released one hang in the air."""
    simulation.step(10)
    held_at = simulation.snapshot().positions[4, 3].copy()
    simulation.pin(4, 3)
    simulation.step(10)
    after = simulation.snapshot()
    assert np.array_equal(after.positions[4, 3], held_at)
    assert np.array_equal(after.velocities[4, 3], (0.0, 0.0, 0.0))
    assert after.flags[4, 3] == 1
    simulation.release(4, 3)
    simulation.step(10)
    assert simulation.snapshot().positions[4, 3, 2] < held_at[2]


@pytest.mark.parametrize('node', [(5, 0), (0, 7), (-1, 0)])
def test_a_pin_outside_is_refused(simulation: Simulation, node: tuple[int, int]):
    """A node of another row, or no node at all, would be pinned."""
    with pytest.raises(ClothSimError, match=r'there is no node .* in a cloth of 5 x 7 nodes'):
        simulation.pin(*node)
    assert simulation.pinned_nodes().sum() == 2


def test_the_nearest_node_is_found(simulation: Simulation):
    """A click would grab the wrong node."""
    x, y, z = simulation.snapshot().positions[3, 2].tolist()
    found = simulation.nearest_node((x + 0.01, y - 0.01, z + 0.03))
    assert (found.row, found.col) == (3, 2)
    assert found.distance == pytest.approx((2 * 0.01**2 + 0.03**2)**0.5, rel=1e-5)
    with pytest.raises(ClothSimError, match='3 finite numbers'):
        simulation.nearest_node((x, y, float('nan')))


def test_only_modes_that_exist_are_taken(simulation: Simulation):
    """The cloth would go on in another mode than was asked for."""
    assert simulation.set_mode('mass_spring') == 'mass_spring'
    with pytest.raises(ClothSimError, match="there is no mode 'rigid': choose one of"):
        simulation.set_mode('rigid')
    assert simulation.mode == 'mass_spring'


def test_a_dt_above_the_limit_is_refused_with_the_way_out():
    """The cloth would blow up, and the user not know why."""
    values = {**_SMALL, 'dt': 0.05, 'auto_substeps': False}
    with pytest.raises(ClothSimError) as caught:
        Simulation(Scene(values))
    message = str(caught.value)
    assert 'dt 0.05 s in 1 substeps is above the stability limit' in message
    offered = float(message.split('set dt <= ')[1].split(',')[0])
    Simulation(Scene({**SPRINGS, **values, 'dt': offered})).close()
    Simulation(Scene({**SPRINGS, **values, 'auto_substeps': True})).close()


def test_more_substeps_than_can_be_meant_are_refused():
    """The first step would never end."""
    stiff = {**_SMALL, 'dt': 1.0, 'stiffness.structural': 1e9}
    with pytest.raises(ClothSimError) as caught:
        Simulation(Scene(stiff))
    message = str(caught.value)
    assert 'substeps of the' in message
    offered = float(message.split('set dt <= ')[1].split(',')[0])
    Simulation(Scene({**SPRINGS, **stiff, 'dt': offered * 0.999})).close()


def test_a_state_that_is_not_finite_is_seen():
    """Cloth of NaN would be published as if it were real."""
    simulation = Simulation(
        Scene({**SPRINGS, **_SMALL, 'dt': 0.05, 'auto_substeps': False, 'start.jitter': 0.1}),
        check_stability=False, stop_at_non_finite=False)
    assert simulation.measure().finite
    simulation.step(400)
    assert not simulation.measure().finite
    assert not simulation.snapshot().finite


def test_measure_and_snapshot_agree(simulation: Simulation):
    """Stats without a cloud would differ from stats with one."""
    simulation.step(25)
    measures, snapshot = simulation.measure(), simulation.snapshot()
    for name, value in vars(measures).items():
        assert getattr(snapshot, name) == value, name


@pytest.mark.parametrize('bad', [
    np.zeros((7, 5, 3)), np.full((5, 7, 3), np.nan), np.full((5, 7, 3), 1e39)])
def test_a_bad_state_is_refused(simulation: Simulation, bad: np.ndarray):
    """A wrong array would end up on the device."""
    before = simulation.snapshot().state_sha256
    with pytest.raises(ClothSimError, match='positions must be'):
        simulation.set_state(bad, np.zeros((5, 7, 3)))
    assert simulation.snapshot().state_sha256 == before


@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive'])
@pytest.mark.parametrize('values', [
    {**SPRINGS, 'pushes.start': [0.1013], 'pushes.duration': [0.03], 'pushes.force': [0, 0, 0.3],
     'pushes.center': [0.0, 0.0, 0.0], 'pushes.radius': [0.0],
     'pin_moves.node': ['0,0'], 'pin_moves.target': [-0.4, 0.0, 0.1],
     'pin_moves.start': [0.2007], 'pin_moves.speed': [1.0],
     'grasps.name': ['hand'], 'grasps.start': [0.3011], 'grasps.release': [0.3505],
     'grasps.position': [0.0, -0.5, 0.0], 'grasps.count': [2]},
    {'air.wind': [0.5, 0.2, 0.0]}])
def test_many_steps_at_once_are_the_same_steps(mode: str, values: dict):
    """A push, a move, a grasp or a gust that begins amid steps made at once would come late."""
    scene = Scene({'rows': 12, 'cols': 9, 'dt': 0.001, 'start.jitter': 0.02, **values,
                   'mode': mode})
    with Simulation(scene) as at_once, Simulation(scene) as one_by_one:
        at_once.step(400)
        for _ in range(400):
            one_by_one.step()
        assert at_once.snapshot().state_sha256 == one_by_one.snapshot().state_sha256
        assert np.abs(at_once.velocities()).max() > 0.01


@pytest.mark.parametrize('values', [
    {'layout': 'paper'}, {'loads': 'storage', 'block': 1}, {'loads': 'texture', 'block': 2},
    {'loads': 'storage', 'block': 4}])
def test_layouts_are_one_scheme(values: dict):
    """A benchmark would compare different physics."""
    start = {**_SMALL, 'rows': 9, 'start.jitter': 0.05}
    usual, other = Simulation(Scene(start)), Simulation(Scene({**SPRINGS, **start, **values}))
    usual.step(25)
    other.step(25)
    np.testing.assert_allclose(
        other.snapshot().positions, usual.snapshot().positions, atol=2e-6)


def test_a_cloth_of_2048_x_2048_runs():
    """Large cloth would be cut off where one buffer or one dispatch ends."""
    scene = Scene({**SPRINGS, 'rows': 2048, 'cols': 2048, 'dt': 1e-6, 'damping.structural': 0.0,
                   'damping.shear': 0.0, 'damping.bend': 0.0})
    simulation = Simulation(scene)
    simulation.step(3)
    snapshot = simulation.snapshot()
    fallen = scene['gravity'][2] * 1e-6 * 3 * np.ones((2048, 2048))
    fallen[scene.pinned_nodes()] = 0.0
    np.testing.assert_allclose(snapshot.velocities[..., 2], fallen, atol=2e-9)
    np.testing.assert_allclose(
        snapshot.positions[..., :2], scene.rest_positions()[..., :2], atol=1e-7)
    speeds = snapshot.velocities.astype(np.float64)
    assert snapshot.kinetic_energy == pytest.approx(
        0.5 * scene.node_mass * np.sum(speeds**2), rel=1e-5)
    simulation.close()


def test_a_block_closes_it():
    """Programs that make many cloths would run out of device memory."""
    with Simulation(Scene(_SMALL)) as simulation:
        simulation.step()
    simulation.close()
    for use in (simulation.step, simulation.positions, simulation.snapshot):
        with pytest.raises(DeviceError, match='is closed: create a new Simulation'):
            use()


def test_several_run_side_by_side():
    """Two cloths on one thread would write into each other's state."""
    with Simulation(Scene(_SMALL)) as first, Simulation(Scene(_SMALL)) as second:
        first.step(10)
        assert np.all(second.velocities() == 0.0)
        second.step(5)
        second.step(5)
        np.testing.assert_array_equal(second.positions(), first.positions())


def test_velocities_are_those_of_the_snapshot(simulation: Simulation):
    """The state that is read could not be given back by set_state."""
    simulation.move_pin(0, 0, (-0.5, 0.5, 1.5), speed=0.25)
    simulation.step(7)
    velocities = simulation.velocities()
    np.testing.assert_array_equal(velocities, simulation.snapshot().velocities)
    np.testing.assert_allclose(velocities[0, 0], (0.0, 0.0, 0.25), atol=1e-6)


def test_pin_forces_are_those_of_the_snapshot(simulation: Simulation):
    """The short way would give the forces of another instant, or of other pins."""
    simulation.step(20)
    held, whole = simulation.pin_forces(), simulation.snapshot(pin_forces=True).pin_forces
    assert held.nodes.tolist() == [[0, 0], [0, 6]]
    np.testing.assert_array_equal(held.forces, whole.forces)


class _Heard(InputListener):
    """Stores the inputs it is notified of, with their times, and can refuse a new state."""

    def __init__(self) -> None:
        self.inputs: list[tuple[Input, float]] = []
        self.refuses = False

    def check(self, given):
        if self.refuses and isinstance(given, ReplaceState):
            raise ClothSimError('no')

    def accept(self, given, time):
        self.inputs.append((given, time))


def test_a_listener_hears_of_each_accepted_input_once(simulation: Simulation):
    """A recording of the run would lack an input, or hold one that was refused."""
    heard = simulation.listener = _Heard()
    simulation.step(5)
    simulation.push((0.0, 0.0, 1.0), duration=0.1)
    simulation.pin(4, 3)
    simulation.move_pin(4, 3, (0.0, 0.0, 1.0))
    simulation.release(4, 3)
    simulation.set_mode('constraint')
    simulation.set_mode('constraint')
    simulation.clear_pushes()
    for refused in (
            lambda: simulation.push((0.0, 0.0, 1.0), duration=-1.0),
            lambda: simulation.pin(9, 9), lambda: simulation.move_pin(2, 2, (0.0, 0.0, 1.0)),
            lambda: simulation.set_mode('none')):
        with pytest.raises(ClothSimError):
            refused()
    positions, velocities = simulation.positions(), simulation.velocities()
    simulation.set_state(positions, velocities)
    simulation.reset()
    push = Push.checked(force=(0.0, 0.0, 1.0), start=0.02, duration=0.1)
    expected = [
        PushNodes(push), Pin(4, 3), MovePin(4, 3, (0.0, 0.0, 1.0), simulation.scene['pin_speed']),
        Unpin(4, 3), SetMode('constraint', 'mass_spring'), SetMode('constraint', 'constraint'),
        ClearPushes(), ReplaceState, Reset()]
    for (given, time), one in zip(heard.inputs, expected, strict=True):
        assert given == one or type(given) is one
        assert time == 0.02
    heard.refuses = True
    with pytest.raises(ClothSimError):
        simulation.set_state(positions + 1.0, velocities)
    assert not np.array_equal(simulation.positions(), positions + 1.0)
