# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A step that leads out of all bounds is undone, and the error says what to change."""

from collections.abc import Callable
from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.device.observer import Observer
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.guarded_steps import GuardedSteps
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.loads.loads import Loads
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.state import State
from cloth_sim_ros.sim.stop import never
from cloth_sim_ros.sim.stop import StepAbandoned
from cloth_sim_ros.sim.stop import Stop
import numpy as np
import pytest
from springs import SPRINGS

_SMALL = {**SPRINGS, 'rows': 7, 'cols': 9, 'dt': 0.004}
_ABSURD = (0.0, 0.0, 1e20)


@pytest.fixture(params=modes.AVAILABLE)
def mode(request: pytest.FixtureRequest) -> str:
    """Return each mode there is."""
    return request.param


@pytest.fixture
def simulate(context: Context) -> Iterator[Callable[..., Simulation]]:
    """Return a function from scene values to a simulation, which ends with the test."""
    opened = []

    def start(values: dict, **options) -> Simulation:
        opened.append(
            Simulation(Scene({**SPRINGS, **_SMALL, **values}), context=context, **options))
        return opened[-1]

    yield start
    for simulation in opened:
        simulation.close()


def _stop(simulation: Simulation, steps: int) -> NonFiniteStateError:
    with pytest.raises(NonFiniteStateError) as caught:
        simulation.step(steps)
    return caught.value


def test_the_last_finite_state_is_kept(simulate, mode):
    """The run would end in NaN, or earlier than it has to."""
    # 0.06 s is the end of step 15, amid the batch.
    simulation = simulate({'mode': mode})
    simulation.push(_ABSURD, start=0.0605, duration=1.0)
    error = _stop(simulation, 100)
    assert error.steps == simulation.steps == 15
    assert simulation.time == pytest.approx(0.06)
    kept = simulation.snapshot()
    assert kept.finite and kept.max_strain < 1.0
    undisturbed = simulate({'mode': mode})
    undisturbed.step(15)
    assert kept.state_sha256 == undisturbed.snapshot().state_sha256


@pytest.mark.parametrize('batch', [1, 7, 40])
def test_batches_stop_at_the_same_state(simulate, batch):
    """Where a run stops would depend on how it was asked to advance."""
    simulation = simulate({})
    simulation.push(_ABSURD, start=0.0605, duration=1.0)
    with pytest.raises(NonFiniteStateError):
        for _ in range(40):
            simulation.step(batch)
    assert simulation.steps == 15


def test_the_run_can_go_on_without_the_cause(simulate, mode):
    """Pushes that ended or began in steps that were undone would be lost, or act twice."""
    runs = []
    for force in (None, _ABSURD):
        simulation = simulate({'mode': mode})
        # It begins and ends in the steps that are made twice.
        simulation.push(
            (0.0, 0.0, 0.5), start=0.0445, duration=0.004, region='sphere', center=(0.0, 0.0, 1.0),
            radius=0.4)
        if force is not None:
            simulation.push(force, start=0.0605, duration=1.0)
            _stop(simulation, 100)
            assert simulation.clear_pushes() == 1
        else:
            simulation.step(15)
        simulation.step(20)
        runs.append(simulation.snapshot())
    assert runs[0].time == runs[1].time
    if mode == 'mass_spring':
        assert runs[0].state_sha256 == runs[1].state_sha256
    # What a mode keeps from step to step begins anew.
    np.testing.assert_allclose(runs[0].positions, runs[1].positions, atol=1e-3)


def test_moving_pins_go_back_too(simulate, mode):
    """A pin would be ahead of its cloth after a stop, or drift when it is held there."""
    runs = []
    for force in (None, _ABSURD):
        simulation = simulate({'mode': mode})
        simulation.step(15)
        simulation.move_pin(0, 0, (-0.4, 0.6, 1.1), speed=1.0)
        if force is not None:
            simulation.push(force, start=0.0605, duration=1.0)
            _stop(simulation, 100)
            assert simulation.steps == 15
            assert np.array_equal(simulation.snapshot().velocities[0, 0], (0.0, 0.0, 0.0))
            simulation.clear_pushes()
        simulation.step(10)
        runs.append(simulation.snapshot())
    assert np.array_equal(runs[0].positions[0, 0], runs[1].positions[0, 0])
    np.testing.assert_allclose(runs[0].positions, runs[1].positions, atol=1e-3)


def test_contact_forces_are_those_of_the_state_that_is_kept(simulate, mode):
    """A stop showed those of the lost step, 9e7 N in mode adaptive instead of 0.04 N."""
    found = []
    for force in (None, _ABSURD):
        simulation = simulate({
            'mode': mode, 'colliders.names': ['ball'], 'colliders.ball.size': [0.2],
            'colliders.ball.position': [0.0, 0.0, 0.79]})
        if force is not None:
            simulation.push(force, start=0.0605, duration=1.0)
            _stop(simulation, 100)
        else:
            simulation.step(15)
        force, = simulation.contact_forces()
        found.append((force.force.tolist(), force.torque.tolist(), force.sliding, force.sticking))
    assert found[0] == found[1]
    assert found[0][0][2] < 0.0


def test_reset_after_a_stop_is_the_start_again(simulate, mode):
    """A reset would leave something of the blow-up over."""
    simulation = simulate({'mode': mode})
    simulation.step(30)
    first = simulation.snapshot().state_sha256
    simulation.push(_ABSURD, duration=1.0)
    _stop(simulation, 100)
    simulation.reset()
    simulation.step(30)
    assert simulation.snapshot().state_sha256 == first


def test_time_does_not_run_ahead_of_a_stop(simulate):
    """The next advance would make up for all steps omitted by a stop."""
    simulation = simulate({})
    simulation.push(_ABSURD, start=0.06, duration=1.0)
    with pytest.raises(NonFiniteStateError):
        simulation.advance(2.0)
    simulation.clear_pushes()
    assert simulation.advance(0.02) == 5


@pytest.mark.parametrize(('values', 'push', 'said'), [
    ({}, {'force': _ABSURD, 'duration': 1.0}, 'push with less force'),
    ({}, {'force': (1e30, 0.0, 0.0), 'duration': 1e-9}, 'push with less force'),
    ({'dt': 0.05, 'auto_substeps': False, 'start.jitter': 0.1}, None,
     'times the stability limit; the state at'),
])
def test_the_error_says_when_where_and_what_to_change(simulate, values, push, said):
    """The user would not know what to do."""
    simulation = simulate(values, check_stability=False)
    if push:
        simulation.push(**push)
    error = _stop(simulation, 1000)
    message = str(error)
    assert said in message
    assert f'in the step from t = {simulation.time:.6g} s' in message
    assert f'first at node ({error.node[0]}, {error.node[1]}), in mode mass_spring' in message
    assert 'must stay below 1e+12 m and m/s' in message
    if push is None:
        offered = float(message.split('set dt <= ')[1].split(',')[0])
        stable = simulate({**values, 'dt': offered}, check_stability=False)
        stable.step(1000)
        assert stable.measure().finite


_IMPLICIT = {
    'mode': 'constraint', 'auto_substeps': False, 'constraint.newton_iterations': 1,
    'constraint.strain': 1e-4, 'rows': 12, 'cols': 12, 'start.jitter': 0.01}


_TOO_FEW_ITERATIONS = {
    **_IMPLICIT, 'dt': 0.1, 'rows': 32, 'cols': 32, 'constraint.strain': 1e-5,
    'auto_substeps': True, 'constraint.newton_iterations': 2, 'solver.max_iterations': 1}
_TOO_LONG_STEPS = {**_IMPLICIT, 'dt': 0.05, 'solver.max_iterations': 2000}


@pytest.mark.parametrize(('values', 'cause', 'offered'), [
    (_TOO_FEW_ITERATIONS, 'solves stopped at solver.max_iterations 1,',
     'raise solver.max_iterations'),
    (_TOO_LONG_STEPS, 'edges rotated by',
     'constraint.newton_iterations: 2, or auto_substeps: true')])
def test_advice_fits_an_implicit_step(simulate, values, cause, offered):
    """A blow-up in mode constraint was answered by "set auto_substeps", which was on."""
    message = str(_stop(simulate(values), 2000))
    assert cause in message and offered in message
    assert 'spring' not in message and 'stability limit' not in message
    assert values['auto_substeps'] != ('auto_substeps' in message)


@pytest.mark.parametrize(('values', 'changes'), [
    # Two minutes and more, nearly all of them in its first three steps.
    pytest.param(
        _TOO_FEW_ITERATIONS, {'solver.max_iterations': 60}, marks=pytest.mark.long),
    (_TOO_LONG_STEPS, {'auto_substeps': True, 'constraint.newton_iterations': 2})])
def test_advice_for_an_implicit_step_helps(simulate, values, changes):
    """The user would follow it, and lose the cloth again."""
    simulation = simulate({**values, **changes})
    simulation.step(20)
    assert simulation.measure().finite


def test_the_node_that_was_lost_is_named(simulate):
    """The user would look at the wrong place."""
    simulation = simulate({'pins': ['all'], 'gravity': [0.0, 0.0, 0.0]})
    simulation.release(4, 6)
    simulation.push(_ABSURD, duration=1.0)
    assert _stop(simulation, 100).node == (4, 6)


def test_what_would_leave_float32_is_stopped_before(simulate):
    """Energies would be infinite while the state is still finite."""
    simulation = simulate({'pins': ['none']})
    positions = simulation.snapshot().positions
    simulation.set_state(positions, np.full_like(positions, 0.999e12))
    assert np.isfinite(simulation.measure().total_energy)
    error = _stop(simulation, 1000)
    snapshot = simulation.snapshot()
    assert error.steps == simulation.steps > 200
    assert np.isfinite(snapshot.total_energy)
    with pytest.raises(ClothSimError, match=r'velocities must be .* below 1e\+12'):
        simulation.set_state(positions, np.full_like(positions, 1.001e12))


@pytest.mark.parametrize('scale', [1e-9, 1e-6, 1.0, 1e6, 1e11])
def test_normals_do_not_depend_on_the_size(simulate, scale):
    """Normals of very small or large cloth would point up, or be no numbers."""
    simulation = simulate({})
    flat = simulation.scene.rest_positions() - (0.0, 0.0, 1.0)
    tilted = np.stack([flat[..., 0], 0.6 * flat[..., 1], 0.8 * flat[..., 1]], axis=-1)
    simulation.set_state(scale * tilted, np.zeros_like(tilted))
    np.testing.assert_allclose(
        simulation.snapshot().normals, np.broadcast_to((0.0, -0.8, 0.6), tilted.shape), atol=1e-5)


class _Remembering(MassSpring):
    """Springs that throw the nodes off by what they remember, until they forget it."""

    name = 'remembering'
    remembers = True

    def step(self, state: State, begin: float, loads: Loads, stop: Stop = never) -> None:
        """Step ``state`` on by one dt."""
        super().step(state, begin, loads, stop)
        if self.remembers:
            self._passes.substep(state, Forcing(_ABSURD), 1.0)

    def forget(self) -> None:
        """Remember nothing."""
        self.remembers = False


def test_a_blow_up_by_memory_alone_is_told():
    """A run whose failure was cleared would continue as if nothing had happened."""
    scene, context = Scene(_SMALL), Context(single_thread=True)
    layout = choose_layout(scene, context)
    state = State(layout, scene.start_positions(), scene.pinned_nodes())
    observer = Observer(scene, layout, set(scene.families))
    loads = Loads(scene, layout, state)
    guard, mode = GuardedSteps(scene, layout, observer, state), _Remembering(scene, layout)

    def step(number: int, most: int, stop: Stop) -> int:
        mode.step(state, number * scene['dt'], loads, stop)
        return 1

    with pytest.raises(
            NonFiniteStateError, match='without what the mode had carried over') as caught:
        guard.make(0, 3, step, mode, loads)
    assert caught.value.steps == 3
    assert observer.measure(state, loads.still, None).finite
    guard.make(3, 3, step, mode, loads)
    for part in (guard, mode, loads, observer, state):
        part.delete()
    context.close()


class _Counted:
    """Steps that are counted, on a state that stays as it is."""

    def __init__(self, context: Context) -> None:
        self.scene = Scene({**_SMALL, 'auto_substeps': False, 'substeps': 16})
        layout = choose_layout(self.scene, context)
        self.state = State(layout, self.scene.start_positions(), self.scene.pinned_nodes())
        self.observer = Observer(self.scene, layout, set(self.scene.families))
        self.loads = Loads(self.scene, layout, self.state)
        self.guard = GuardedSteps(self.scene, layout, self.observer, self.state)
        self.mode = MassSpring(self.scene, layout)
        self.steps: list[int] = []
        self.settled: list[int] = []

    def make(self, first: int, count: int, **asked: Callable[[], bool]) -> None:
        """Make steps by the guard, with what is asked."""
        self.guard.make(
            first, count, self._step, self.mode, self.loads, settle=self.settled.append, **asked)

    def _step(self, number: int, most: int, stop: Stop) -> int:
        self.steps.append(number)
        return 1

    def close(self) -> None:
        """Release everything."""
        for part in (self.guard, self.mode, self.loads, self.observer, self.state):
            part.delete()


@pytest.fixture
def counted(context: Context) -> Iterator[_Counted]:
    """Give steps of 16 substeps, of which 64 are checked together."""
    counted = _Counted(context)
    assert (counted.mode.substeps, counted.mode.checked_substeps) == (16, 64)
    yield counted
    counted.close()


def test_steps_count_when_they_have_passed_a_check(counted):
    """A time would be shown that a blow-up takes back."""
    counted.make(2, 10)
    assert counted.steps == list(range(2, 12))
    assert counted.settled == [6, 10, 12]


def test_the_step_that_is_due_is_the_last(counted):
    """A frame would have more steps than were asked for."""
    counted.make(0, 10, is_due=lambda: counted.steps[-1] == 5)
    assert counted.settled == [4, 6] and counted.steps[-1] == 5


def test_steps_before_the_last_check_stay(counted):
    """A shutdown would take back what has been shown."""
    with pytest.raises(StepAbandoned):
        counted.make(0, 10, stop=lambda: len(counted.steps) == 6)
    assert counted.settled == [4] and counted.steps[-1] == 5


def test_it_can_be_turned_off(simulate):
    """A study could not look at a blow-up."""
    simulation = simulate({}, stop_at_non_finite=False)
    simulation.push(_ABSURD, duration=1.0)
    simulation.step(100)
    assert simulation.steps == 100
    assert not simulation.measure().finite
