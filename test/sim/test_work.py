# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Work ends when it is due; a step that is abandoned leaves the cloth as it was checked last."""

from collections.abc import Callable
from collections.abc import Iterator
from typing import Any

from abandoned import abandon
from abandoned import calls_of
from abandoned import StopAfter
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import InputListener
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stop import StepAbandoned
import numpy as np
import pytest
from springs import SPRINGS

_SCENE = {**SPRINGS, 'rows': 8, 'cols': 9, 'dt': 0.01, 'auto_substeps': True}
# All that a step can change: what is timed begins and ends in the steps that are abandoned.
_BUSY = {
    **_SCENE, 'auto_substeps': False, 'substeps': 16,
    'air.density': 1.2, 'air.drag': 1.0, 'air.wind': [0.5, 0.0, 0.0],
    'gusts.start': [0.03], 'gusts.duration': [0.03], 'gusts.wind': [0.0, 0.0, 2.0],
    'pushes.start': [0.0, 0.045], 'pushes.duration': [0.06, 0.02],
    'pushes.force': [0.0, 0.0, 0.3, 0.0, 0.2, 0.0], 'pushes.center': [0.0, 0.0, 1.0] * 2,
    'pushes.radius': [0.0, 0.3],
    'pin_moves.node': ['0,0'], 'pin_moves.start': [0.04], 'pin_moves.target': [-0.4, 0.45, 1.05],
    'pin_moves.speed': [0.5],
    'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.2],
    'colliders.ball.position': [0.0, 0.0, 0.785], 'collider_moves.start': [0.01],
    'collider_moves.name': ['ball'], 'collider_moves.target': [0.0, 0.0, 0.9],
    'collider_moves.speed': [0.3]}
_MODES = {
    **{mode: {'mode': mode} for mode in modes.AVAILABLE},
    'adaptive, limited': {'mode': 'adaptive', 'adaptive.threshold': 0.01},
    'adaptive, paper': {
        'mode': 'adaptive', 'adaptive.scheme': 'paper', 'adaptive.threshold': 0.01}}


@pytest.fixture(autouse=True)
def in_small_pieces(monkeypatch: pytest.MonkeyPatch):
    """Have a piece for every substep, as in a large cloth: steps alike are made in runs."""
    monkeypatch.setattr('cloth_sim_ros.sim.modes.mass_spring._NODES_AT_ONCE', 1)


@pytest.fixture(params=_MODES)
def simulate(request: pytest.FixtureRequest, context: Context) -> Iterator[Callable]:
    """Return a function that makes a cloth in each mode there is."""
    opened = []

    def make(values: dict[str, Any] = _SCENE) -> Simulation:
        values = {**values, **_MODES[request.param]}
        if values.get('adaptive.scheme') == 'paper':  # which has no contact
            values = {name: value for name, value in values.items() if 'collider' not in name}
        opened.append(Simulation(Scene(values), context=context))
        return opened[-1]

    yield make
    for simulation in opened:
        simulation.close()


class Busy:
    """A cloth on which everything acts, with its forces since the third step."""

    def __init__(self, simulation: Simulation) -> None:
        """Bring it to the third step."""
        self.cloth = simulation
        self.begin()

    def begin(self) -> None:
        """Make the first three steps."""
        cloth = self.cloth
        cloth.grasp('hand', cloth.positions()[7, 4].astype(float), radius=0.2)
        cloth.move_grasp('hand', (0.0, -0.45, 1.05), (0.1, 0.0, 0.0, 1.0), speed=1.0)
        cloth.pin(4, 8)
        cloth.move_pin(4, 8, (0.45, 0.0, 1.0), speed=0.5)
        self.windows = [cloth.open_force_window() for _ in range(2)]
        cloth.step(3)
        cloth.frame_forces(self.windows[0])

    def begin_again(self) -> None:
        """Reset, and make the first three steps."""
        for window in self.windows:
            self.cloth.close_force_window(window)
        self.cloth.reset()
        self.begin()

    def look(self) -> dict[str, Any]:
        """Return all that steps change, to the bit, but the forces of its windows."""
        cloth = self.cloth
        return {
            'steps': cloth.steps, 'time': cloth.time, 'is behind': cloth.stepping.is_behind,
            'positions': cloth.positions().tobytes(), 'velocities': cloth.velocities().tobytes(),
            'pinned': cloth.pinned_nodes().tobytes(), 'pushes': cloth.pushes,
            'pin moves': cloth.pin_moves, 'colliders': cloth.colliders, 'wind': cloth.loads.wind,
            'grasps': [(grasp.name, grasp.pose, grasp.nodes.tolist()) for grasp in cloth.grasps],
            'grasp paths': [path.move for path in cloth.grasp_paths],
            'pin forces': cloth.pin_forces().forces.tobytes(),
            'pin peaks': cloth.pin_forces().peaks.tobytes(),
            'grasp forces': [
                (each.force.tobytes(), each.torque.tobytes()) for each in cloth.grasp_forces()],
            'contact forces': [_numbers(each) for each in cloth.contact_forces()],
            'flags': cloth.snapshot().flags.tobytes(),
            'stalled pins': cloth.snapshot().stalled_pins}

    def frames(self) -> list[Any]:
        """Return the forces of its windows, and begin these anew."""
        return [
            (found.seconds, found.pins.forces.tobytes(), found.pins.peaks.tobytes(),
             [(each.force.tobytes(), each.torque.tobytes()) for each in found.grasps],
             [_numbers(each) for each in found.contacts])
            for found in map(self.cloth.frame_forces, self.windows)]


def _numbers(force: Any) -> tuple:
    return force.force.tobytes(), force.torque.tobytes(), force.sticking, force.sliding


def forget(simulation: Simulation) -> None:
    """Drop what the mode carries over from earlier steps, as an abandoned step does."""
    simulation.engines.forget()


def test_work_ends_when_it_is_due_and_goes_on_to_its_aim(simulate):
    """A frame would be cut short, or steps be made twice."""
    simulation = simulate()
    simulation.stepping.aim(0.055)
    made = []
    while simulation.stepping.is_behind:
        simulation.work(lambda: True)
        made.append(simulation.steps)
    assert made == [1, 2, 3, 4, 5]
    simulation.stepping.aim(0.005)
    assert simulation.stepping.is_behind
    simulation.work()
    assert simulation.steps == 6


def test_who_is_asked_does_not_change_the_bits(simulate):
    """A cloth would move otherwise in a node that is asked much."""
    whole, asked = Busy(simulate(_BUSY)), Busy(simulate(_BUSY))
    whole.cloth.step(6)
    asked.cloth.stepping.aim_steps(6)
    while asked.cloth.stepping.is_behind:
        asked.cloth.work(lambda: True, StopAfter(1e9))
        asked.cloth.nearest_node((0.0, 0.0, 0.0), max_distance=9.0)
        asked.look()
    assert asked.look() == whole.look()
    assert asked.frames() == whole.frames()


def test_steps_ask_often_whether_to_stop(simulate):
    """A shutdown would wait for all steps of a frame, or for a step of many substeps."""
    assert calls_of(Busy(simulate(_BUSY)).cloth, steps=4) >= 4 * 16
    # Nothing acts here, so that steps are made in runs.
    assert calls_of(simulate(), steps=4) >= 4


def test_an_abandoned_step_leaves_all_as_it_was(simulate):
    """What is shown or recorded last would be half a step, or forces of one that never was."""
    cut, twin = Busy(simulate(_BUSY)), Busy(simulate(_BUSY))
    # The first time, each program is run by itself, with a question after it.
    calls_of(cut.cloth, steps=9)
    cut.begin_again()
    calls = calls_of(cut.cloth, steps=9)
    ends = set()
    for after in np.linspace(0, calls - 1, 7).astype(int):
        cut.begin_again()
        abandon(cut.cloth, steps=9, after=int(after))
        twin.begin_again()
        twin.cloth.step(cut.cloth.steps - 3)
        forget(twin.cloth)
        ends.add(cut.cloth.steps)
        assert cut.look() == twin.look(), after
        assert cut.frames() == twin.frames(), after
        # It goes on to the same bits.
        for each in (cut, twin):
            each.cloth.step(7)
        assert cut.look() == twin.look(), after
        assert cut.frames() == twin.frames(), after
    # Those that were checked before are kept.
    assert min(ends) == 3 and (max(ends) > 3 or len(ends) == 1)


@pytest.mark.parametrize('error', [KeyboardInterrupt, MemoryError])
def test_an_error_within_a_step_leaves_all_as_it_was(simulate, error):
    """A program that handles Ctrl-C would continue with half a step."""
    cut, twin = Busy(simulate(_BUSY)), Busy(simulate(_BUSY))
    abandon(cut.cloth, steps=2, after=9, error=error)
    forget(twin.cloth)
    assert cut.look() == twin.look()
    for each in (cut, twin):
        each.cloth.step(7)
    assert cut.look() == twin.look() and cut.frames() == twin.frames()


def test_an_abandoned_step_can_be_abandoned_again(simulate):
    """The second time, the state would go back too far."""
    cut, twin = Busy(simulate(_BUSY)), Busy(simulate(_BUSY))
    for after in (0, 9, 30, 5):
        abandon(cut.cloth, steps=2, after=after)
    forget(twin.cloth)
    assert cut.look() == twin.look()
    assert cut.frames() == twin.frames()


def test_inputs_after_an_abandoned_step_act_from_its_begin(simulate):
    """A reset or another mode would begin from half a step."""
    cut, twin = Busy(simulate(_BUSY)), Busy(simulate(_BUSY))
    abandon(cut.cloth, steps=2, after=9)
    forget(twin.cloth)
    for each in (cut, twin):
        each.cloth.pin(3, 3)
        each.cloth.push((0.0, 0.0, 0.1), duration=0.05)
        each.cloth.release_grasp('hand')
        each.cloth.set_mode('mass_spring')
        each.cloth.step(4)
    assert cut.look() == twin.look()
    for each in (cut, twin):
        each.begin_again()
        each.cloth.step(4)
    assert cut.look() == twin.look()


def test_abandoned_steps_are_not_made_up_for(simulate):
    """The next advance would make the steps of the last one, too."""
    simulation = simulate()
    abandon(simulation, steps=50, after=1)
    assert not simulation.stepping.is_behind
    before = simulation.steps
    assert simulation.advance(0.02) == 2 and simulation.steps == before + 2


class _Releases(InputListener):
    def __init__(self) -> None:
        self.names: list[str] = []

    def accept(self, given, time):
        self.names.append(given.name)


def test_a_grasp_is_not_lost_in_an_abandoned_step(simulate):
    """A gripper would let go because of a pull that never was."""
    simulation = simulate()
    simulation.grasp('weak', simulation.positions()[7, 4].astype(float), max_force=0.01)
    simulation.listener = _Releases()
    # Its frame has moved in the steps before the one in which the cloth pulls too hard.
    abandon(simulation, steps=30, after=1)
    assert [grasp.name for grasp in simulation.grasps] == ['weak']
    assert simulation.listener.names == []
    simulation.step(30)
    assert simulation.grasps == () and simulation.listener.names == ['weak']


@pytest.mark.parametrize('argument', ['is_due', 'stop'])
def test_what_is_asked_must_be_a_function(context, argument):
    """A run would end in a TypeError, with its aim kept."""
    with Simulation(Scene(_SCENE), context=context) as simulation:
        with pytest.raises(ClothSimError, match=f'{argument} must be a function'):
            simulation.work(**{argument: 3})


def test_a_stop_that_asks_at_once_makes_no_step(simulate):
    """A node that ends would make one more step, of any length."""
    simulation = simulate()
    simulation.stepping.aim_steps(1)
    with pytest.raises(StepAbandoned):
        simulation.work(stop=lambda: True)
    assert simulation.steps == 0
