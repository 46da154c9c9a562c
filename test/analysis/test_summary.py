# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A recording in a few numbers."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.messages.points import PointsMessage
from cloth_sim_ros.messages.state import state_message
from cloth_sim_ros.messages.stats import stats_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from made_snapshot import make_snapshot
import pytest
from rclpy.serialization import serialize_message


def test_everything_is_counted(known):
    """The demo and its reader would be told of another run."""
    summary = summarise(Recording(known.folder))
    assert (summary.rows, summary.cols, summary.frames) == (5, 4, 26)
    assert summary.device == 'a device'
    assert summary.modes == ['mass_spring']
    assert (summary.begin, summary.end) == (0.0, pytest.approx(0.48))
    assert (summary.dt, summary.substeps) == (0.005, 3)
    assert (summary.pushes, summary.releases, summary.pins, summary.resets) == (2, 1, 0, 1)
    assert summary.finite


def test_largest_and_last_are_told_apart(known):
    """A peak in the middle of a run would be missed, or reported as its end."""
    summary = summarise(Recording(known.folder))
    assert summary.largest_strain == pytest.approx(0.19)
    assert summary.last_strain == pytest.approx(0.05)
    assert summary.largest_kinetic_energy == 19.0
    assert summary.last_kinetic_energy == 5.0


def test_frames_that_stood_still_do_not_slow_the_pace(known):
    """A pause would look like a machine that is too slow."""
    assert summarise(Recording(known.folder)).real_time_factor == 0.5


def test_a_run_that_blew_up_is_told(tmp_path):
    """The figures of a broken run would look like a good one's."""
    recorder = Recorder(tmp_path, 'bag', 'cloth_sim')
    good = make_snapshot(2, 2, max_strain=0.2)
    bad = make_snapshot(
        2, 2, time=1.5, max_strain=float('nan'), kinetic_energy=float('nan'), finite=False)
    recorder.write('points', PointsMessage(2, 2, 'world').serialise(good), good.time)
    for snapshot in (good, bad):
        stats = stats_message(snapshot, 'world', step_wall_time=0.0, real_time_factor=1.0)
        recorder.write('stats', serialize_message(stats), snapshot.time)
    recorder.close()
    summary = summarise(Recording(tmp_path / 'bag'))
    assert not summary.finite
    assert summary.largest_strain == pytest.approx(0.2)


def test_a_run_that_stopped_before_it_blew_up_is_told(tmp_path):
    """A run that broke off would look like one that came to its end."""
    recorder = Recorder(tmp_path, 'bag', 'cloth_sim')
    good = make_snapshot(2, 2)
    recorder.write('points', PointsMessage(2, 2, 'world').serialise(good), good.time)
    recorder.write('stats', serialize_message(stats_message(good, 'world')), good.time)
    recorder.write('state', serialize_message(state_message(
        frame_id='world', sim_time=good.time, mode='adaptive', available_modes=['adaptive'],
        run_state='stopped', rows=2, cols=2, dt=0.005, substeps=3, stability_limit=0.002,
        device='a device')), good.time)
    recorder.close()
    assert not summarise(Recording(tmp_path / 'bag')).finite


def test_a_recording_without_frames_is_refused(tmp_path):
    """A user would get a summary full of zeros."""
    Recorder(tmp_path, 'empty', 'cloth_sim').close()
    with pytest.raises(ClothSimError, match='contains no messages'):
        summarise(Recording(tmp_path / 'empty'))
