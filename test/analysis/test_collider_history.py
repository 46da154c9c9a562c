# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Colliders of a recording are where they were in the run."""

from cloth_sim_ros.analysis.collider_history import ColliderHistory
from cloth_sim_ros.analysis.entry import Entry
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.api.simulation_recorder import SimulationRecorder
from cloth_sim_ros.messages.inputs import command_message
from cloth_sim_ros.messages.inputs import frame_target_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import place_message
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.sim.colliders import fields_with_colliders
from cloth_sim_ros.sim.frame_paths import FrameMove
from cloth_sim_ros.sim.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from springs import SPRINGS

VALUES = {
    **SPRINGS,
    'rows': 3, 'cols': 3, 'start.z': 5.0, 'colliders.names': ['ball', 'floor'],
    'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.1],
    'colliders.ball.position': [0.0, 1.0, 0.0], 'colliders.floor.shape': 'plane',
    'collider_moves.start': [0.5], 'collider_moves.name': ['ball'],
    'collider_moves.target': [1.0, 1.0, 0.0], 'collider_moves.speed': [2.0]}


def opened(values=VALUES):
    """Return the history of a run that has just begun."""
    history = ColliderHistory()
    message = parameters_message(
        Scene(values).values, fields_with_colliders(values), 0.0, 'cloth_sim')
    history.read(Entry('inputs/parameters', 0.0, message))
    return history


def place_of(history, time):
    """Return the position of the ball at ``time`` [s]."""
    ball, floor = history.at(stamp(time))
    assert (ball.name, ball.shape, ball.size) == ('ball', 'sphere', (0.1,))
    assert floor.shape == 'plane' and floor.position == (0.0, 0.0, 0.0)
    return ball.position


def test_moves_of_the_scene_are_followed():
    """A ball that hits a curtain would be drawn where it was at the start."""
    history = opened()
    for time, x in ((0.0, 0.0), (0.5, 0.0), (0.7, 0.4), (2.0, 1.0)):
        assert place_of(history, time) == pytest.approx((x, 1.0, 0.0)), time


def test_recorded_targets_replace_them_and_a_reset_brings_them_back():
    """What a service or a stream has moved would stand still, or stay away after a reset."""
    history = opened()
    move = FrameMove.checked(
        name='ball', target=(0.4, 2.0, 0.0), orientation=None, speed=0.5, angular_speed=1.0,
        start=0.7)
    history.read(Entry('inputs/collider_target', 0.7, frame_target_message(move, 0.7, 'world')))
    assert place_of(history, 1.7) == pytest.approx((0.4, 1.5, 0.0))
    reset = command_message('clear_pushes', 1.8, 'world')
    history.read(Entry('inputs/command', 1.8, reset))
    assert place_of(history, 9.0) == pytest.approx((0.4, 2.0, 0.0))
    history.read(Entry('inputs/command', 2.0, command_message('reset', 2.0, 'world')))
    assert place_of(history, 0.1) == pytest.approx((0.0, 1.0, 0.0))


def test_a_recording_from_the_middle_of_a_run_says_where_they_are():
    """A ball that was moved before the recording began would be drawn elsewhere."""
    history = opened()
    place = place_message('ball', Pose((3.0, 3.0, 3.0)), 4.0, 'world')
    history.read(Entry('inputs/collider_target', 4.0, place))
    assert place_of(history, 4.1) == (3.0, 3.0, 3.0)


def test_a_run_without_colliders_has_none():
    """Pictures of other scenes would change."""
    assert ColliderHistory().at(stamp(1.0)) == ()
    history = opened({'rows': 3, 'cols': 3})
    assert history.at(stamp(1.0)) == () and history.problem == ''


def test_what_this_version_does_not_know_is_left_out_and_told():
    """A recording of a later version could not be drawn at all."""
    message = parameters_message(
        Scene(VALUES).values, fields_with_colliders(VALUES), 0.0, 'cloth_sim')
    for parameter in message.new_parameters:
        if parameter.name == 'colliders.ball.shape':
            parameter.value.string_value = 'torus'
    history = ColliderHistory()
    history.read(Entry('inputs/parameters', 0.0, message))
    assert history.at(stamp(1.0)) == () and 'torus' in history.problem


def test_frames_have_the_colliders_of_the_run(tmp_path):
    """The picture of a recording would show another scene than the run was."""
    scene = Scene({**SPRINGS, **VALUES, 'colliders.ball.orientation': [0.0, 0.6, 0.0, 0.8]})
    seen = []
    with Simulation(scene) as run, SimulationRecorder(
            run, tmp_path, 'run', parameters={'publish.rate': 10.0}) as recorder:
        for number in range(10):
            if number == 6:
                run.move_collider('ball', (0.0, 0.0, 3.0), (1.0, 0.0, 0.0, 1.0), speed=1.5)
            seen.append((run.time, run.colliders))
            recorder.advance(0.1)
    found = {frame.time: frame.colliders for frame in read_frames(Recording(tmp_path / 'run'))}
    for time, colliders in seen:
        recorded = found[min(found, key=lambda each: abs(each - time))]
        for expected, body in zip(colliders, recorded, strict=True):
            assert (body.name, body.shape, body.size) == (
                expected.name, expected.shape, expected.size)
            np.testing.assert_allclose(body.position, expected.position, atol=1e-8)
            np.testing.assert_allclose(body.orientation, expected.orientation, atol=1e-8)
    assert len(found) > 9
