# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recorded runs, made again from their recording alone."""

import random

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.scene_fields import MODES
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.main import main
from made_again import assert_same
from made_again import Director
from made_again import made_again
import numpy as np
import pytest
from springs import SPRINGS

SCENE = {
    **SPRINGS,
    'rows': 8, 'cols': 9, 'dt': 1.0 / 180.0, 'start.jitter': 0.1,
    'pushes.start': (0.0, 0.11), 'pushes.duration': (0.05, 0.2),
    'pushes.force': (0.0, 0.0, 2.0, 1.0, 0.0, 0.0),
    'pushes.center': (0.0, 0.0, 0.0, 0.0, -0.4, 0.9), 'pushes.radius': (0.0, 0.4),
    'pin_moves.start': (0.03, 0.15), 'pin_moves.node': ('top_left', 'top_right'),
    'pin_moves.target': (-0.4, 0.5, 1.1, 0.4, 0.5, 1.0)}


def act(director, chance):
    """Do something at random."""
    row, col = chance.randrange(8), chance.randrange(9)
    corner = chance.choice((0, 8))
    force = tuple(chance.uniform(-1.0, 1.0) for _ in 'xyz')
    target = (0.4 if corner else -0.4, 0.5, chance.uniform(0.9, 1.1))
    chance.choice((
        lambda: director.push(force, duration=chance.uniform(1e-3, 0.3)),
        lambda: director.push(
            force, duration=0.1, region='sphere', center=(0.0, 0.2, 0.9), radius=0.5,
            start=director.simulation.time + chance.uniform(0.0, 0.1)),
        lambda: director.pin(row, col),
        lambda: director.release(row, col),
        lambda: (director.pin(0, corner), director.move_pin(0, corner, target, 0.8)),
        lambda: director.set_mode(chance.choice(MODES)),
        director.clear_pushes,
        director.reset))()


@pytest.mark.parametrize('seed', [
    0, 1, *(pytest.param(seed, marks=pytest.mark.long) for seed in range(2, 40))])
def test_any_inputs_are_done_again(tmp_path, seed):
    """A run would come out otherwise for an order of inputs that nobody has thought of."""
    chance = random.Random(seed)
    with Director(tmp_path, {**SCENE, 'mode': chance.choice(MODES)}) as director:
        for _ in range(14):
            for _ in range(chance.choice((0, 1, 1, 2))):
                try:
                    act(director, chance)
                except NonFiniteStateError:
                    raise
                except ClothSimError:
                    pass
            director.step(chance.randrange(1, 6))
    assert_same(director.path, director.frames)


@pytest.mark.parametrize('mode', MODES)
def test_a_run_in_the_wind_is_made_again(tmp_path, mode):
    """Gusts, or a wind that was set, would blow at another time; or a reset leave it."""
    air = {'mode': mode, 'air.density': 1.225, 'air.wind': (1.0, 0.0, 0.0), 'gusts.start': (0.05,),
           'gusts.duration': (0.1,), 'gusts.wind': (0.0, 3.0, 2.0)}
    with Director(
            tmp_path, {**SCENE, **air}, lambda cloth: cloth.set_wind((0.0, 0.0, 2.0))) as director:
        director.step(11)
        director.set_wind((0.0, -4.0, 1.0))
        director.step(11)
        director.reset()
        director.step(11)
        director.set_wind((0.0, 2.0, 1.0))
        director.step(11)
    assert_same(director.path, director.frames)


def test_a_recording_from_the_middle_of_a_run_has_the_wind_that_was_set(tmp_path):
    """The wind of the parameters would blow again."""
    def before(cloth):
        cloth.set_wind((0.0, -4.0, 1.0))
        cloth.step(18)

    air = {'rows': 8, 'cols': 9, 'start.jitter': 0.1, 'air.density': 1.225}
    with Director(tmp_path, air, before) as director:
        for _ in range(4):
            director.step(11)
    assert_same(director.path, director.frames)


@pytest.mark.parametrize('before', [
    lambda cloth: cloth.push((0.0, 0.5, 0.0), duration=0.1),
    lambda cloth: cloth.clear_pushes(),
    lambda cloth: (cloth.clear_pushes(), cloth.push((0.0, 0.5, 0.0), duration=0.1)),
    lambda cloth: (cloth.pin(3, 3), cloth.release(0, 8), cloth.set_mode('adaptive')),
    lambda cloth: cloth.move_pin(0, 8, (0.3, 0.4, 1.0), 0.5),
    lambda cloth: [cloth.push((0.0, 0.5, 0.0), duration=0.1) for _ in range(2)],
    lambda cloth: (cloth.step(40), cloth.reset()),
], ids=['push', 'clear', 'clear and push', 'pins and mode', 'move', 'twice', 'reset'])
def test_what_was_done_before_the_first_step_counts_once(tmp_path, before):
    """The scene's pushes would act twice, or those of a user not at all."""
    with Director(tmp_path, SCENE, before) as director:
        for _ in range(5):
            director.step(11)
    assert_same(director.path, 6)


def test_a_recording_from_the_middle_of_a_run_has_the_same_bits_in_mass_spring(tmp_path):
    """The scene's pushes and moves that are over would come again, or those to come not."""
    def before(cloth):
        cloth.push((0.3, 0.0, 1.0), duration=0.5)
        cloth.step(18)  # the first move is over, the second push and move are to come
        cloth.pin(4, 4)
        cloth.release(0, 0)

    with Director(tmp_path, SCENE, before) as director:
        for _ in range(6):
            director.step(9)
    assert_same(director.path, 7)


def test_what_the_middle_of_a_run_does_not_tell_is_named(tmp_path):
    """Bits would be promised that depend on what happened before the recording."""
    def before(cloth):
        cloth.set_mode('adaptive')
        cloth.push((0.1, 0.0, 0.1), duration=0.5, region='sphere', radius=0.6, center=(0, 0, 1))
        cloth.move_pin(0, 8, (0.4, 0.5, 1.1), 0.2)
        cloth.step(15)

    with Director(tmp_path, SCENE, before) as director:
        director.step(9)
    with made_again(director.path) as rerun:
        assert rerun.unknown == (
            'what mode adaptive carried over from earlier steps', 'where the moving pins started',
            'which nodes an active push selected when it began')
        assert rerun.check.frames == 2
        # At first only the pins differ, which have no velocity before they set off.
        assert rerun.check.first.fields == ('vx', 'vz')
        assert rerun.check.largest.distance < 0.01
        assert rerun.simulation.time == director.simulation.time


def test_the_new_recording_is_as_good_as_the_first(tmp_path):
    """A run made again could not be made again, or would lack inputs."""
    chance = random.Random(7)
    with Director(tmp_path, SCENE) as director:
        for _ in range(12):
            act(director, chance)
            director.step(3)
    assert main(['resimulate', str(director.path), '--out', str(tmp_path / 'new')]) == 0
    new, = (tmp_path / 'new').iterdir()
    assert new.name == f'{director.path.name}_again'
    assert_same(new, director.frames)
    assert inputs_of(new) == inputs_of(director.path)
    assert RecordedRun(Recording(new)).scene.values == RecordedRun(
        Recording(director.path)).scene.values


def inputs_of(path):
    """Return the recorded inputs but for the parameters, as text."""
    return [(entry.time, repr(entry.message)) for entry in Recording(path).entries(*(
        f'inputs/{key}' for key in ('push', 'pin', 'pin_target', 'mode', 'command')))]


@pytest.fixture
def eventful(tmp_path):
    """Return a recording with a push, a pin, a switch of the mode and a reset, and its frames."""
    with Director(tmp_path, {**SPRINGS, 'rows': 8, 'cols': 9}) as director:
        director.step(10)
        director.push((0.0, 0.5, 1.0), duration=0.1)
        director.pin(7, 7)
        director.step(10)
        director.set_mode('adaptive')
        director.step(10)
        director.reset()
        director.step(20)
    return director.path


def by_hand(**values):
    """Return where ``eventful`` ends in its first life, with other settings."""
    simulation = Simulation(Scene({**SPRINGS, 'rows': 8, 'cols': 9, **values}))
    for act in (
            lambda: simulation.push((0.0, 0.5, 1.0), duration=0.1) and simulation.pin(7, 7),
            lambda: 'mode' in values or simulation.set_mode('adaptive'),
            lambda: None):
        simulation.advance(0.05)
        act()
    positions = simulation.snapshot().positions
    simulation.close()
    return positions


@pytest.mark.parametrize('changes', [
    {'mode': 'constraint'}, {'mode': 'adaptive'}, {'areal_density': 0.3}, {'dt': 0.0025},
    {'dt': 0.01}], ids=str)
def test_other_settings_get_the_same_inputs(eventful, changes):
    """A comparison would be with another experiment than the recorded one."""
    largest = np.linalg.norm(by_hand(**changes) - by_hand(), axis=-1).max()
    with made_again(eventful, **changes) as rerun:
        assert rerun.changed == tuple(changes)
        assert rerun.left_out_modes == ('mode' in changes)
        assert (rerun.refused, rerun.problem) == ([], '')
        assert rerun.check.frames == 6
        assert rerun.simulation.time == pytest.approx(0.1)
        at_the_switch = rerun.check.largest
    if largest > 1e-4:
        assert at_the_switch.distance >= 0.999 * largest


def test_other_nodes_are_not_compared_node_by_node(eventful):
    """Nodes would be compared that have nothing to do with each other."""
    with made_again(eventful, rows=16) as rerun:
        assert (rerun.check.frames, rerun.check.other_grids) == (0, 6)
        assert rerun.refused == []
