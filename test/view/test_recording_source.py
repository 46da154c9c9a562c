# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording in the view shows the frames it holds, each at its time."""

from pathlib import Path
import time

from cloth_sim_ros.analysis.frames import read_frames
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.view.recording_source import RecordingSource
import numpy as np
import pytest

EXAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'example'


@pytest.fixture(scope='module')
def frames():
    """Read the frames of the recording."""
    return list(read_frames(Recording(EXAMPLE)))


def test_it_shows_the_frame_of_each_time(frames):
    """The view would show another moment than the slider says."""
    source = RecordingSource(EXAMPLE)
    assert source.span == (frames[0].time, frames[-1].time)
    for frame in (frames[7], frames[-1], frames[0]):
        source.go_to(frame.time)
        shown = source.latest()
        assert (shown.frame.time, shown.run_state) == (frame.time, 'paused')
        np.testing.assert_array_equal(shown.frame.records, frame.records)
    source.go_to(0.5 * (frames[3].time + frames[4].time))
    assert source.latest().frame.time == frames[3].time
    assert source.latest().mode


def test_it_plays_to_its_end_and_then_from_the_begin(frames):
    """A recording would stand still, or go on past its end."""
    source = RecordingSource(EXAMPLE)
    source.go_to(frames[-3].time)
    source.set_paused(False)
    deadline = time.monotonic() + 300.0
    while source.latest().run_state == 'running':
        assert time.monotonic() < deadline
        time.sleep(0.01)
    assert source.latest().frame.time == frames[-1].time
    source.set_paused(False)
    source.set_paused(True)
    assert source.latest().frame.time < frames[-1].time


def test_a_large_recording_keeps_as_many_frames_as_fit(frames):
    """The memory of the machine would not do for a long recording."""
    size = frames[0].records.nbytes
    source = RecordingSource(EXAMPLE, most_bytes=size * len(frames) // 3)
    kept = []
    for frame in frames:
        source.go_to(frame.time)
        kept.append(source.latest().frame.time)
    assert len(set(kept)) <= len(frames) // 3 + 1
    assert kept[0] == frames[0].time


def test_what_is_no_recording_is_refused(tmp_path):
    """A page would be served that never shows anything."""
    with pytest.raises(ClothSimError):
        RecordingSource(tmp_path)


def test_what_a_recording_cannot_do_is_refused_by_name():
    """A view that asked for it anyway would end in a traceback without a way out."""
    source = RecordingSource(EXAMPLE)
    for ask, what in (
            (lambda: source.set_mode('adaptive'), 'change its mode'),
            (lambda: source.step(1), 'step'),
            (source.reset, 'be reset'),
            (lambda: source.push((0, 0, 1), (0, 0, 0), 0.1, 1.0), 'be pushed'),
            (lambda: source.hold(0, 0), 'take new pins'),
            (lambda: source.release(0, 0), 'release pins'),
            (lambda: source.move_pin(0, 0, (0, 0, 1)), 'move pins')):
        with pytest.raises(ClothSimError, match=f'cannot {what}: view a scene or a running node'):
            ask()
