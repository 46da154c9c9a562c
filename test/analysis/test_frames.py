# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The frames of a recording in the order of time, with the colliders where they are then."""

from cloth_sim_ros.analysis.frames import ColliderHistory
from cloth_sim_ros.analysis.frames import default_times
from cloth_sim_ros.analysis.frames import frame_at
from cloth_sim_ros.analysis.frames import frames_at
from cloth_sim_ros.analysis.frames import panel_times
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Entry
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.api.simulation_recorder import SimulationRecorder
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import place_message
from cloth_sim_ros.messages.stamp import stamp
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import ClearPushes
from cloth_sim_ros.sim.inputs import MoveCollider
from cloth_sim_ros.sim.inputs import Reset
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.push import Push
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
        Scene(values).values, all_fields(values), 0.0, 'cloth_sim')
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


def test_recorded_targets_until_reset():
    """A collider moved by a service or stream would stand still, or stay moved after a reset."""
    history = opened()

    def give(given, time):
        key, message = input_message(given, time, 'world')
        history.read(Entry(key, time, message))

    give(MoveCollider('ball', (0.4, 2.0, 0.0), None, 0.5, 1.0), 0.7)
    assert place_of(history, 1.7) == pytest.approx((0.4, 1.5, 0.0))
    give(ClearPushes(), 1.8)
    assert place_of(history, 9.0) == pytest.approx((0.4, 2.0, 0.0))
    give(Reset(), 2.0)
    assert place_of(history, 0.1) == pytest.approx((0.0, 1.0, 0.0))


def test_collider_poses_in_a_late_recording():
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


def test_unknown_colliders_are_skipped_with_a_note():
    """A recording of a later version could not be drawn at all."""
    message = parameters_message(
        Scene(VALUES).values, all_fields(VALUES), 0.0, 'cloth_sim')
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


# Frames of a recording and the pushes that go with them.


@pytest.mark.parametrize('time, nearest', [
    (-1.0, 0.0), (0.0, 0.0), (0.029, 0.02), (0.031, 0.04), (99.0, 0.48)])
def test_the_nearest_frame_is_taken(known, time, nearest):
    """A picture would carry the wrong time, or fail beyond the ends."""
    frame, = frames_at(Recording(known.folder), [time])
    assert frame.time == pytest.approx(nearest)


@pytest.mark.parametrize('time, nearest', [
    (None, 0.48), (-1e-7, 0.0), (0.0, 0.0), (0.029, 0.02), (0.031, 0.04), (0.48 + 1e-7, 0.48)])
def test_a_frame_near_a_time(known, time, nearest):
    """A mesh would be of another time than asked for."""
    assert frame_at(Recording(known.folder), time).time == pytest.approx(nearest)


@pytest.mark.parametrize('time', [-0.01, 0.49])
def test_no_frame_beyond_the_ends(known, time):
    """A mesh would be of another time than asked for, by any amount."""
    with pytest.raises(ClothSimError, match=f'frames from 0 to 0.48 s, and none at {time} s'):
        frame_at(Recording(known.folder), time)


def test_one_frame_can_be_asked_for_twice(known):
    """Times closer together than the frames would shift all that follow."""
    frames = frames_at(Recording(known.folder), [0.1, 0.101, 0.2])
    assert [frame.time for frame in frames] == pytest.approx([0.1, 0.1, 0.2])


def test_pushes_act_from_their_start_to_their_end(known):
    """A picture would show a push at the wrong time."""
    acting = [
        frame.time for frame in read_frames(Recording(known.folder))
        if any(push.force == (0.0, 0.0, 2.0) for push in frame.acting_pushes)]
    # The frame at its start was sent before the push was given.
    assert acting == pytest.approx([0.12, 0.14, 0.16, 0.18])


def test_a_reset_ends_the_pushes(known):
    """A push that was taken back would be drawn until its planned end."""
    last = list(read_frames(Recording(known.folder)))[-1]
    assert last.acting_pushes == ()


def test_default_times_show_each_push(known):
    """The picture of a run would miss what was done to the cloth."""
    recording = Recording(known.folder)
    times = default_times(recording, 6)
    assert times == sorted(times)
    assert times[0] == 0.0 and times[-1] == pytest.approx(0.48)
    seen = {push.force for frame in frames_at(recording, times) for push in frame.acting_pushes}
    assert seen == {(0.0, 0.0, 2.0), (3.0, 0.0, 0.0)}


@pytest.mark.parametrize('read', [
    frame_at, lambda recording: frames_at(recording, [1.0]),
    lambda recording: default_times(recording, 3)])
def test_a_recording_without_frames_is_refused(tmp_path, read):
    """A user would get an empty picture and no reason."""
    Recorder(tmp_path, 'empty', 'cloth_sim').close()
    with pytest.raises(ClothSimError, match='contains no messages: give'):
        read(Recording(tmp_path / 'empty'))


def push(start, duration):
    """Return a push that acts then."""
    return Push.checked(force=(1.0, 0.0, 0.0), start=start, duration=duration)


def test_without_pushes_they_are_evenly_apart():
    """Part of a run would not be seen."""
    assert panel_times(1.0, 3.0, [], 5) == pytest.approx([1.0, 1.5, 2.0, 2.5, 3.0])


def test_the_nearest_moves_into_a_push():
    """A short push would fall between two panels."""
    assert panel_times(0.0, 4.0, [push(2.3, 0.2)], 5) == pytest.approx([0.0, 1.0, 2.4, 3.0, 4.0])


def test_two_pushes_close_together_are_both_seen():
    """The second push would take the panel of the first."""
    times = panel_times(0.0, 4.0, [push(1.9, 0.2), push(2.2, 0.2)], 5)
    assert times == pytest.approx([0.0, 1.0, 2.0, 2.3, 4.0])


def test_more_pushes_than_panels_are_no_harm():
    """A run with many pushes could not be drawn."""
    times = panel_times(0.0, 1.0, [push(0.1 * number, 0.05) for number in range(10)], 4)
    assert len(times) == 4 and times == sorted(times)


def test_one_panel_is_enough():
    """A single panel could not be asked for."""
    assert panel_times(0.5, 1.0, [push(0.6, 0.1)], 1) == [0.5]
