# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frames of a recording and the pushes that go with them."""

from cloth_sim_ros.analysis.frames import default_times
from cloth_sim_ros.analysis.frames import frames_at
from cloth_sim_ros.analysis.frames import panel_times
from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.push import Push
import pytest


@pytest.mark.parametrize('time, nearest', [
    (-1.0, 0.0), (0.0, 0.0), (0.029, 0.02), (0.031, 0.04), (99.0, 0.48)])
def test_the_nearest_frame_is_taken(known, time, nearest):
    """A picture would carry the wrong time, or fail beyond the ends."""
    frame, = frames_at(Recording(known.folder), [time])
    assert frame.time == pytest.approx(nearest)


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
    lambda recording: frames_at(recording, [1.0]), lambda recording: default_times(recording, 3)])
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
