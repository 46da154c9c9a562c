# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Pins reach their targets at the requested times, and stay there."""

from collections.abc import Iterator
from contextlib import closing

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.device.layout import choose_layout
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.held.pin_motion import PinMotion
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cloth_sim_ros.sim.state import State
import numpy as np
import pytest
from springs import SPRINGS

_SMALL = {**SPRINGS, 'rows': 5, 'cols': 7, 'dt': 0.004}
_TIMED = {
    **SPRINGS,
    **_SMALL, 'pin_moves.start': [0.01, 0.05], 'pin_moves.node': ['0,6', 'top_left'],
    'pin_moves.target': [0.5, 0.5, 1.2, -0.6, 0.5, 1.0], 'pin_moves.speed': [2.0, 1.0]}
NAN, INF = float('nan'), float('inf')


@pytest.fixture
def simulation(context) -> Iterator[Simulation]:
    """Give a small cloth with two pins, at its start."""
    with closing(Simulation(Scene(_SMALL), context=context)) as simulation:
        yield simulation


def run_until(simulation: Simulation, time: float) -> None:
    """Step until ``time`` [s]."""
    simulation.step(round((time - simulation.time) / simulation.dt))


def test_a_pin_goes_straight_and_arrives_exactly(simulation: Simulation):
    """A gripper's way would not be followed, or be missed by what rounding adds up."""
    origin = simulation.snapshot().positions[0, 0].astype(float)
    target = np.array((-0.123456789, 0.61, 1.3))
    way = target - origin
    arrival = simulation.move_pin(0, 0, target, 0.7).arrival
    assert arrival == pytest.approx(np.linalg.norm(way) / 0.7)
    assert [move.target for move in simulation.pin_moves] == [tuple(target)]
    while simulation.time < arrival - simulation.dt:
        simulation.step()
        snapshot = simulation.snapshot()
        expected = origin + way / np.linalg.norm(way) * 0.7 * simulation.time
        np.testing.assert_allclose(snapshot.positions[0, 0], expected, atol=1e-7)
        np.testing.assert_allclose(
            snapshot.velocities[0, 0], way / np.linalg.norm(way) * 0.7, rtol=1e-6)
        assert snapshot.flags[0, 0] & FLAG_PINNED
    assert simulation.pin_moves
    for _ in range(3):
        simulation.step()
        snapshot = simulation.snapshot()
        np.testing.assert_array_equal(snapshot.positions[0, 0], target.astype(np.float32))
        np.testing.assert_array_equal(snapshot.velocities[0, 0], np.zeros(3))
        assert not simulation.pin_moves


def test_slow_pins_arrive_as_well(context):
    """A pin whose way in a substep is less than float32 can tell would stand still."""
    values = {**_SMALL, 'auto_substeps': False, 'substeps': 1000}
    with closing(Simulation(Scene(values), context=context)) as simulation:
        simulation.move_pin(0, 0, (-0.5, 0.5, 1.00004), 0.001)
        simulation.step(5)
        assert simulation.snapshot().positions[0, 0, 2] == pytest.approx(1.00002, abs=2e-7)
        simulation.step(5)
        assert simulation.snapshot().positions[0, 0, 2] == np.float32(1.00004)


def test_the_scenes_speed_is_taken_where_none_is_given(context):
    """A pin would go at another speed than the parameter says."""
    with closing(Simulation(Scene({**_SMALL, 'pin_speed': 0.25}), context=context)) as simulation:
        assert simulation.move_pin(0, 0, (-0.5, 0.6, 1.0)).arrival == pytest.approx(0.4)


def test_a_new_target_takes_the_place_of_the_old(simulation: Simulation):
    """A stream of targets would be followed late, or with jumps."""
    simulation.move_pin(0, 0, (-0.5, 0.7, 1.0), 1.0)
    run_until(simulation, 0.1)
    arrival = simulation.move_pin(0, 0, (-0.5, 0.6, 1.2), 0.5).arrival
    assert arrival == pytest.approx(0.1 + 0.2 / 0.5)
    assert len(simulation.pin_moves) == 1
    before = simulation.snapshot().positions[0, 0]
    simulation.step()
    np.testing.assert_allclose(
        simulation.snapshot().positions[0, 0], before + (0.0, 0.0, 0.5 * 0.004), atol=1e-7)
    run_until(simulation, 0.6)
    np.testing.assert_array_equal(
        simulation.snapshot().positions[0, 0], np.array((-0.5, 0.6, 1.2), np.float32))


def test_a_released_pin_goes_on_with_its_velocity(context):
    """A thrown cloth would stop in the air."""
    loose = {f'{kind}.{family}': 0.0 for family in FAMILIES for kind in ('stiffness', 'damping')}
    scene = Scene({**SPRINGS, **_SMALL, **loose, 'gravity': [0.0] * 3})
    with closing(Simulation(scene, context=context)) as simulation:
        simulation.move_pin(0, 0, (-0.5, 2.5, 1.0), 2.0)
        simulation.step(10)
        simulation.release(0, 0)
        snapshot = simulation.snapshot()
        np.testing.assert_array_equal(snapshot.velocities[0, 0], (0.0, 2.0, 0.0))
        assert not snapshot.flags[0, 0] & FLAG_PINNED
        assert not simulation.pin_moves
        simulation.step(300)
        np.testing.assert_allclose(
            simulation.snapshot().positions[0, 0], (-0.5, 0.5 + 2.0 * simulation.time, 1.0),
            atol=2e-5)


def test_holding_a_pin_stops_it(simulation: Simulation):
    """A pin on the move could not be stopped."""
    simulation.move_pin(0, 0, (-0.5, 2.5, 1.0), 2.0)
    simulation.step(10)
    simulation.pin(0, 0)
    held = simulation.snapshot().positions[0, 0].copy()
    simulation.step(10)
    np.testing.assert_array_equal(simulation.snapshot().positions[0, 0], held)
    np.testing.assert_array_equal(simulation.snapshot().velocities[0, 0], np.zeros(3))


def test_a_switch_of_the_mode_leaves_the_pin_on_its_way(simulation: Simulation):
    """A gripper would stop, or jump, because another mode steps the cloth."""
    simulation.move_pin(0, 0, (-0.5, 0.6, 1.1), 2.0)
    simulation.step(8)
    before = simulation.snapshot()
    simulation.set_mode('adaptive')
    assert simulation.snapshot().state_sha256 == before.state_sha256
    simulation.step(9)
    np.testing.assert_allclose(
        simulation.snapshot().positions[0, 0] - before.positions[0, 0],
        np.array((0.0, 1.0, 1.0)) * 2.0 / np.sqrt(2.0) * 9 * simulation.dt, atol=2e-7)
    simulation.step(1)
    np.testing.assert_array_equal(
        simulation.snapshot().positions[0, 0], np.array((-0.5, 0.6, 1.1), np.float32))


def test_a_new_state_ends_the_moves(simulation: Simulation):
    """A pin would jump back to the way it was on in the state before."""
    start = simulation.snapshot()
    simulation.move_pin(0, 0, (-0.5, 2.5, 1.0), 2.0)
    simulation.step(10)
    simulation.set_state(start.positions, start.velocities)
    simulation.step(10)
    np.testing.assert_array_equal(
        simulation.snapshot().positions[0, 0], start.positions[0, 0])


def test_a_reset_ends_the_moves(simulation: Simulation):
    """The second run would begin with a move of the first."""
    simulation.step(20)
    first = simulation.snapshot().state_sha256
    simulation.move_pin(0, 0, (-0.5, 2.5, 1.0), 2.0)
    simulation.step(3)
    simulation.reset()
    simulation.step(20)
    assert simulation.snapshot().state_sha256 == first


@pytest.mark.parametrize(('node', 'target', 'speed', 'message'), [
    ((2, 3), (0.0, 0.0, 0.0), 1.0, r'node \(2, 3\) is free and only a pin can be moved: pin it'),
    ((5, 0), (0.0, 0.0, 0.0), 1.0, r'there is no node \(5, 0\)'),
    ((0, 0), (0.0, NAN, 0.0), 1.0, 'target of a pin must be 3 finite numbers'),
    ((0, 0), (0.0, INF, 0.0), 1.0, 'target of a pin must be 3 finite numbers'),
    ((0, 0), (0.0, 0.0), 1.0, 'target of a pin must be 3 finite numbers'),
    ((0, 0), (0.0, 0.0, 1e7), 1.0, r'at most 1e\+06 m along each axis, got .*: keep the cloth'),
    ((0, 0), (0.0, 0.0, 0.0), 0.0,
     'speed of a pin must be from 1e-06 to 1e[+]06 m/s, got 0.0 m/s'),
    ((0, 0), (0.0, 0.0, 0.0), -1.0, 'speed of a pin must be from 1e-06'),
    ((0, 0), (0.0, 0.0, 0.0), NAN, 'speed of a pin must be from 1e-06'),
    ((0, 0), (0.0, 0.0, 0.0), INF, 'speed of a pin must be from 1e-06'),
])
def test_nonsense_is_refused(simulation: Simulation, node, target, speed, message: str):
    """A bad target would tear the cloth, or make it NaN; or end a move under way."""
    simulation.move_pin(0, 0, (-0.5, 0.6, 1.0), 0.1)
    before = simulation.pin_moves
    with pytest.raises(ClothSimError, match=message):
        simulation.move_pin(*node, target, speed)
    assert simulation.pin_moves == before


def test_a_move_to_where_the_pin_is_ends_at_once(simulation: Simulation):
    """A way of no length would be divided by."""
    x, y, z = simulation.snapshot().positions[0, 0].tolist()
    assert simulation.move_pin(0, 0, (x, y, z), 1.0).arrival == 0.0
    simulation.step(2)
    assert not simulation.pin_moves
    assert simulation.snapshot().finite


def test_the_nearest_pin_is_found(simulation: Simulation):
    """A target for a pin would go to a free node beside it."""
    found = simulation.nearest_pin((0.3, -0.5, 1.0), INF)
    assert (found.row, found.col) == (0, 6)
    simulation.release(0, 6)
    found = simulation.nearest_pin((0.3, -0.5, 1.0), INF)
    assert (found.row, found.col) == (0, 0)
    simulation.release(0, 0)
    with pytest.raises(ClothSimError, match='pin a node first'):
        simulation.nearest_pin((0.0, 0.0, 0.0))


def test_timed_moves_begin_at_their_times(context):
    """The moves of a scene would be late, early, or mixed up; or come once in two runs."""
    with closing(Simulation(Scene(_TIMED), context=context)) as simulation:
        for _ in range(2):
            simulation.step(3)
            # It has moved for 2 ms of a step of 4 ms.
            assert simulation.snapshot().positions[0, 6, 2] == pytest.approx(1.004, abs=1e-6)
            assert simulation.snapshot().velocities[0, 6, 2] == pytest.approx(1.0)
            simulation.step(10)
            positions = simulation.snapshot().positions
            assert positions[0, 6, 2] == pytest.approx(1.084, abs=1e-6)
            assert positions[0, 0, 0] == pytest.approx(-0.502, abs=1e-6)
            run_until(simulation, 0.2)
            np.testing.assert_array_equal(
                simulation.snapshot().positions[0, [6, 0]],
                np.array([(0.5, 0.5, 1.2), (-0.6, 0.5, 1.0)], np.float32))
            simulation.reset()


def test_a_timed_move_of_a_released_node_does_nothing(context):
    """A free node would be moved as if it were held, or the run would end."""
    with closing(Simulation(Scene(_TIMED), context=context)) as simulation:
        simulation.release(0, 6)
        run_until(simulation, 0.2)
        assert simulation.snapshot().positions[0, 6, 2] < 0.95


def test_a_new_move_within_a_step_goes_on_from_the_old(context):
    """A pin would leave its way where two moves meet."""
    values = {
        **_SMALL, 'pin_moves.start': [0.0, 0.01], 'pin_moves.node': ['0,6', '0,6'],
        'pin_moves.target': [0.5, 0.5, 2.0, 0.5, 0.5, 1.0], 'pin_moves.speed': [1.0, 1.0]}
    with closing(Simulation(Scene(values), context=context)) as simulation:
        simulation.step(3)
        assert simulation.snapshot().positions[0, 6, 2] == pytest.approx(1.008, abs=1e-6)
        assert simulation.snapshot().velocities[0, 6, 2] == pytest.approx(0.0, abs=1e-6)
        simulation.step(2)
        assert simulation.snapshot().positions[0, 6, 2] == 1.0


def test_only_changes_of_velocity_count():
    """A mode would look ahead in each step, or miss a change; or a pin's force be wrong."""
    scene = Scene(_SMALL)
    with closing(Context()) as context:
        context.make_current()
        state = State(
            choose_layout(scene, context), scene.start_positions(), scene.pinned_nodes())
        motion = PinMotion(scene, state)
        # 14 mm at 4 mm a step: three whole steps and half a one.
        motion.move(0, 0, (-0.5, 0.5, 1.014), 1.0, 0.0)
        edits, velocities = [state.edits], []
        for step in range(6):
            motion.begin_step(step * scene['dt'], (step + 1) * scene['dt'])
            velocities.append(motion.velocities[0, 0][2])
            motion.end_step(step * scene['dt'], (step + 1) * scene['dt'])
            edits.append(state.edits)
        state.delete()
    # It sets off, slows down, and comes to rest at the end of that step.
    assert np.diff(edits).tolist() == [1, 0, 0, 2, 0, 0]
    np.testing.assert_allclose(velocities, [1.0, 1.0, 1.0, 0.5, 0.0, 0.0], atol=1e-9)
    assert not motion.velocities[0, 0].any()
    assert (0, 6) not in motion.velocities
