# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Make a recorded run again, as far as a recording can hold it."""

import random

from builtin_interfaces.msg import Time
from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Command
from cloth_sim_interfaces.msg import PinChange
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.recording.bag_reader import BagReader
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.resimulation.rerun import MOST_FRAMES
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.main import main
from made_again import assert_same
from made_again import Director
from made_again import made_again
from made_cloud import make_cloud
import numpy as np
from PIL import Image
import pytest
from rclpy.serialization import serialize_message
from springs import SPRINGS
from std_msgs.msg import Header

LATEST = 2**31 - 1  # [s] that a stamp can have


def at(sec, nanosec=0):
    """Return a header of this time."""
    return Header(stamp=Time(sec=sec, nanosec=nanosec))


def refusal_of(path, **changes):
    """Return the words with which a recording is refused."""
    with pytest.raises(ClothSimError) as error:
        with made_again(path, **changes):
            pass
    return str(error.value)


@pytest.mark.parametrize(('key', 'message'), [
    ('stats', ClothStats(header=at(LATEST))),
    ('inputs/command', Command(header=at(LATEST), command='clear_pushes')),
    ('stats', ClothStats(header=at(3)))], ids=['frame', 'input', 'some seconds'])
def test_a_stamp_far_ahead_is_refused(tmp_path, key, message):
    """Sixty-eight years would be simulated for one wrong byte."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}) as director:
        director.step(4)
        director.send(key, message)
    assert f'has a message on ~/{key} of ' in (words := refusal_of(director.path))
    assert 'after one of 0.02 s, and at 50 frames per second' in words


def test_the_longest_gap_that_frames_may_have_is_made(tmp_path):
    """A recording that lacks some frames could not be made again."""
    with Director(tmp_path, {'rows': 2, 'cols': 2}) as director:
        director.step(4 * MOST_FRAMES)
    with made_again(director.path) as rerun:
        assert rerun.check.equal == rerun.check.frames == 2


def test_a_recording_without_frames_may_be_silent_for_long(tmp_path):
    """A run whose topics were switched off could not be made again."""
    with Director(tmp_path, {'rows': 2, 'cols': 2}) as director:
        director.send('inputs/parameters', parameters_message(
            {'publish.points': False, 'publish.stats': False}, FIELDS, 0.0, 'cloth_sim',
            is_change=True))
        director.simulation.step(4 * MOST_FRAMES + 400)
        director.send('inputs/command', Command(header=at(4), command='clear_pushes'))
    with made_again(director.path) as rerun:
        assert rerun.simulation.steps == 800


def recorded(folder, values, *messages):
    """Record parameters and what follows, serialised, all at the time 0."""
    recorder = Recorder(folder, 'made', 'cloth_sim')
    recorder.write('inputs/parameters', serialize_message(
        parameters_message(values, FIELDS, 0.0, 'cloth_sim')), 0.0)
    for key, data in messages:
        recorder.write(key, data, 0.0)
    recorder.close()
    return recorder.path


def test_more_nodes_than_a_cloud_has_are_refused(tmp_path):
    """A few bytes would take gigabytes of the device."""
    path = recorded(
        tmp_path, {'rows': 2048, 'cols': 2048}, ('points', make_cloud(8, 8, 0)[0]))
    words = refusal_of(path)
    assert '2048 x 2048 nodes and clouds of 8 x 8: give --set rows' in words
    with made_again(path, rows=8, cols=8) as rerun:
        assert rerun.check.frames == 1


def test_many_nodes_without_a_cloud_have_to_be_asked_for(tmp_path):
    """A few bytes would take gigabytes of the device."""
    stats = serialize_message(ClothStats())
    path = recorded(tmp_path, {'rows': 8192, 'cols': 8192}, ('stats', stats))
    assert '8192 x 8192 nodes but no cloud' in refusal_of(path)


def test_a_beginning_before_zero_is_refused(tmp_path):
    """Steps would be counted from below zero, and the shaders get what is none."""
    recorder = Recorder(tmp_path, 'made', 'cloth_sim')
    message = parameters_message({'rows': 8, 'cols': 8}, FIELDS, 0.0, 'cloth_sim')
    message.stamp = Time(sec=-5)
    recorder.write('inputs/parameters', serialize_message(message), 0.0)
    recorder.close()
    assert 'begins at -5 s, before 0' in refusal_of(recorder.path)


def test_pin_outside_the_cloth_is_refused(tmp_path):
    """A recording from the middle of a run would end as a traceback."""
    with Director(tmp_path, {'rows': 8, 'cols': 9}, lambda cloth: cloth.step(3)) as director:
        pass
    # What holds at the beginning stands before the first frame.
    recorder = Recorder(tmp_path, 'outside', 'cloth_sim')
    for message in BagReader(director.path).messages():
        key = message.topic.removeprefix('/cloth_sim/')
        if key.startswith('/'):
            continue
        recorder.write(key, message.data, 0.0)
        if key == 'inputs/parameters':
            recorder.write('inputs/pin', serialize_message(PinChange(
                header=at(0, 15_000_000), row=2**32 - 1, col=3, pinned=True)), 0.0)
    recorder.close()
    assert 'a pin at node (4294967295, 3), and the cloth has 8 x 9' in refusal_of(recorder.path)


# Recorded runs, made again from their recording alone.

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
    cloth = director.simulation
    chance.choice((
        lambda: cloth.push(force, duration=chance.uniform(1e-3, 0.3)),
        lambda: cloth.push(
            force, duration=0.1, region='sphere', center=(0.0, 0.2, 0.9), radius=0.5,
            start=cloth.time + chance.uniform(0.0, 0.1)),
        lambda: cloth.pin(row, col),
        lambda: cloth.release(row, col),
        lambda: (cloth.pin(0, corner), cloth.move_pin(0, corner, target, 0.8)),
        lambda: cloth.set_mode(chance.choice(MODES)),
        cloth.clear_pushes,
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
        director.simulation.set_wind((0.0, -4.0, 1.0))
        director.step(11)
        director.reset()
        director.step(11)
        director.simulation.set_wind((0.0, 2.0, 1.0))
        director.step(11)
    assert_same(director.path, director.frames)


def test_late_recording_keeps_the_set_wind(tmp_path):
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


def test_late_recording_has_the_same_bits_in_mass_spring(tmp_path):
    """Finished pushes and moves of the scene would repeat, or scheduled ones be lost."""
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
        director.simulation.push((0.0, 0.5, 1.0), duration=0.1)
        director.simulation.pin(7, 7)
        director.step(10)
        director.simulation.set_mode('adaptive')
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


@pytest.mark.parametrize('mode', MODES)
def test_a_cut_cloth_is_made_again_without_its_mask(tmp_path, mode):
    """A recording would need an image that only its author has."""
    white = np.zeros((24, 26), np.uint8)
    white[2:20, 3:24] = 255
    white[8:12, 9:15] = 0
    Image.fromarray(white).save(tmp_path / 'mask.png')
    values = {
        'rows': 13, 'cols': 14, 'shape.mask': str(tmp_path / 'mask.png'), 'mode': mode,
        'pin_points.positions': (-0.35, 0.4, 1.0), 'pin_points.max_distance': 0.1}
    with Director(tmp_path, values) as director:
        director.step(10)
        director.simulation.push((0.0, 0.0, 0.2), duration=0.02)
        director.simulation.move_pin(*np.argwhere(director.simulation.pinned_nodes())[0].tolist(),
                                     (0.0, 0.0, 1.1))
        director.step(20)
    (tmp_path / 'mask.png').unlink()
    with made_again(director.path) as rerun:
        assert rerun.check.equal == rerun.check.frames == 3
