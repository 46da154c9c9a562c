# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Steps made in pieces are the same steps, and what happens between pieces waits for their end."""

from collections.abc import Callable
from collections.abc import Iterator

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim import modes
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from springs import SPRINGS

_SCENE = {'rows': 8, 'cols': 9, 'dt': 0.01, 'auto_substeps': True}
_SPHERE = {'region': 'sphere', 'center': (0.0, 0.0, 1.0), 'radius': 0.3}


@pytest.fixture(autouse=True)
def in_small_pieces(monkeypatch: pytest.MonkeyPatch):
    """Have a piece for every substep, as in a large cloth: steps alike are made in runs."""
    monkeypatch.setattr('cloth_sim_ros.sim.modes.mass_spring._NODES_AT_ONCE', 1)


@pytest.fixture(params=modes.AVAILABLE)
def simulate(request: pytest.FixtureRequest, context: Context) -> Iterator[Callable]:
    """Return a function that makes a cloth in each mode there is."""
    opened = []

    def make() -> Simulation:
        opened.append(Simulation(Scene({
            **SPRINGS, **_SCENE, 'mode': request.param}), context=context))
        return opened[-1]

    yield make
    for simulation in opened:
        simulation.close()


def always() -> bool:
    """Ask for control at every opportunity."""
    return True


def into_a_step(simulation: Simulation, pieces: int = 1) -> Iterator[None]:
    """Return the work of a step of dt that is under way."""
    simulation.stepping.aim_steps(1)
    work = simulation.work(always)
    for _ in range(pieces):
        next(work)
    return work


def finish(work: Iterator[None]) -> None:
    """Go on to the end of the step."""
    for _ in work:
        pass


def test_pieces_make_the_same_bits(simulate):
    """A cloth would move otherwise in a node that is asked much."""
    whole, cut = simulate(), simulate()
    whole.step(6)
    while cut.steps < 6:
        for _ in into_a_step(cut):
            # Looks use the device, and must leave what the step has bound as it was.
            cut.snapshot()
            cut.measure()
            cut.nearest_node((0.0, 0.0, 0.0), max_distance=9.0)
    assert cut.snapshot().state_sha256 == whole.snapshot().state_sha256
    assert cut.time == whole.time


def test_between_pieces_the_state_is_that_before_the_step(simulate):
    """A reader would get half a step: some nodes moved, others not."""
    simulation = simulate()
    simulation.step(3)
    before = simulation.snapshot()
    work = into_a_step(simulation, pieces=2)
    now = simulation.snapshot()
    assert now.state_sha256 == before.state_sha256
    assert now.time == before.time and now.steps == 3
    assert np.array_equal(simulation.positions(), before.positions)
    finish(work)
    assert simulation.steps == 4
    assert simulation.snapshot().state_sha256 != before.state_sha256


def test_changes_are_made_at_the_end_of_the_step(simulate):
    """A step would be part with and part without them, and could not be made again."""
    asked, plain = simulate(), simulate()
    asked.step(3)
    work = into_a_step(asked)
    at = asked.stepping.edit_time
    assert at == pytest.approx(0.04) and asked.time == pytest.approx(0.03)
    applied = asked.push((0.0, 0.0, 0.4), duration=0.05, **_SPHERE)
    asked.pin(3, 4)
    asked.release(0, 0)
    asked.pin(7, 0)
    path = asked.move_pin(7, 0, (-0.5, -0.5, 1.3), speed=0.5)
    assert applied.nodes > 0 and path.begin == at
    assert asked.pinned_nodes()[3, 4] and not asked.pinned_nodes()[0, 0]
    finish(work)

    plain.step(4)
    plain.push((0.0, 0.0, 0.4), duration=0.05, **_SPHERE)
    plain.pin(3, 4)
    plain.release(0, 0)
    plain.pin(7, 0)
    plain.move_pin(7, 0, (-0.5, -0.5, 1.3), speed=0.5)
    for _ in range(3):
        first, second = asked.snapshot(), plain.snapshot()
        assert first.state_sha256 == second.state_sha256
        assert np.array_equal(first.flags, second.flags)
        asked.step(2)
        plain.step(2)


def test_changes_are_checked_when_they_are_asked_for(simulate):
    """The reason of a refusal would come when nobody waits for it."""
    simulation = simulate()
    work = into_a_step(simulation)
    for change, reason in (
            (lambda: simulation.pin(99, 0), 'there is no node'),
            (lambda: simulation.move_pin(4, 4, (0.0, 0.0, 1.0)), 'is free'),
            (lambda: simulation.push((0.0, 0.0, 1.0), duration=-1.0), 'duration'),
            (lambda: simulation.push(
                (0.0, 0.0, 1.0), duration=1.0, region='sphere', center=(9.0, 0.0, 0.0),
                radius=0.1), 'no free node')):
        with pytest.raises(ClothSimError, match=reason):
            change()
    finish(work)
    assert not simulation.pushes


def test_pushes_are_cleared_but_not_those_that_come_after(simulate):
    """A push would act on, or be gone that was asked for after the others were cleared."""
    simulation = simulate()
    simulation.push((0.0, 0.0, 1.0), duration=9.0)
    work = into_a_step(simulation)
    assert simulation.clear_pushes() == 1
    simulation.push((0.0, 0.5, 0.0), duration=9.0)
    finish(work)
    assert [applied.push.force for applied in simulation.pushes] == [(0.0, 0.5, 0.0)]


def test_closed_work_undoes_the_step(simulate):
    """A reset would begin from half a step."""
    simulation, plain = simulate(), simulate()
    for each in (simulation, plain):
        each.step(3)
    before = plain.snapshot().state_sha256
    work = into_a_step(simulation)
    simulation.pin(3, 3)
    work.close()
    assert simulation.snapshot().state_sha256 == before
    assert not simulation.pinned_nodes()[3, 3]
    simulation.reset()
    plain.reset()
    simulation.step(4)
    plain.step(4)
    assert simulation.snapshot().state_sha256 == plain.snapshot().state_sha256


def test_a_stop_keeps_what_was_asked_for_meanwhile(simulate):
    """A release that could save the cloth would be lost with the step that failed."""
    simulation = simulate()
    simulation.push((0.0, 0.0, 1e30), duration=1.0)
    simulation.stepping.aim_steps(5)
    work = simulation.work(always)
    next(work)
    simulation.pin(3, 3)
    simulation.push((0.0, 0.0, 0.1), duration=0.5)
    with pytest.raises(NonFiniteStateError):
        for _ in range(1000):
            finish(work)
            work = simulation.work(always)
    assert simulation.pinned_nodes()[3, 3]
    assert len(simulation.pushes) == 2


def test_what_needs_a_whole_step_is_refused_within_one(simulate):
    """The state would be replaced during a step that uses the old one."""
    simulation = simulate()
    work = into_a_step(simulation)
    for change in (simulation.reset, lambda: simulation.step(1),
                   lambda: simulation.set_mode('mass_spring')):
        with pytest.raises(RuntimeError, match='needs the current step to end'):
            change()
    finish(work)
    simulation.step(1)


def test_work_ends_when_it_is_due_and_goes_on_to_its_aim(simulate):
    """A frame would be cut short, or steps be made twice."""
    simulation = simulate()
    simulation.stepping.aim(0.055)
    made = []
    while simulation.stepping.is_behind:
        finish(simulation.work(always))
        made.append(simulation.steps)
    assert made == [1, 2, 3, 4, 5]
    simulation.stepping.aim(0.005)
    assert simulation.stepping.is_behind
    finish(simulation.work(lambda: False))
    assert simulation.steps == 6


def test_changes_apply_at_the_end_of_their_step(context):
    """A recorded change would have the time of an earlier step than the one that it ended."""
    asked = Simulation(Scene({**SPRINGS, **_SCENE, 'mode': 'mass_spring'}), context=context)
    plain = Simulation(Scene({**SPRINGS, **_SCENE, 'mode': 'mass_spring'}), context=context)
    asked.stepping.aim_steps(6)
    # Two substeps of the third step are made, and none of these steps has been checked.
    left = 2 * asked.substeps + 2
    calls = iter([False] * (left + 1) + [True] * 99)
    work = asked.work(lambda: next(calls))
    next(work)
    assert asked.steps == 0
    assert asked.stepping.edit_time == pytest.approx(0.03)
    path = asked.move_pin(0, 0, (-0.5, 0.5, 1.2), speed=0.5)
    assert path.begin == asked.stepping.edit_time
    finish(work)
    assert asked.steps == 3
    plain.step(3)
    plain.move_pin(0, 0, (-0.5, 0.5, 1.2), speed=0.5)
    for each in (asked, plain):
        each.step(4)
    assert asked.snapshot().state_sha256 == plain.snapshot().state_sha256
    for each in (asked, plain):
        each.close()
