# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording in a few numbers."""

from dataclasses import replace
import math

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.summary import find_gaps
from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.analysis.summary import summary_lines
from cloth_sim_ros.analysis.summary import text_table
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.state import state_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from made_snapshot import make_snapshot
import numpy as np
import pytest
from rclpy.serialization import serialize_message


def test_a_span_without_frames_is_found():
    """A run with a hole would be drawn as if nothing were missing."""
    times = np.array([0.0, 0.02, 0.04, 0.06, 0.3, 0.32, 0.34])
    gap, = find_gaps(times, np.zeros(7))
    assert gap == pytest.approx((0.06, 0.3))


@pytest.mark.parametrize('times, resets', [
    ([], []), ([1.0], [0]), ([0.0, 5.0], [0, 0]),
    (np.arange(50) / 50, np.zeros(50)),
    # At 60 Hz with steps of 5 ms, frames are 3 or 4 steps apart.
    (np.cumsum([3, 3, 4] * 20) * 0.005, np.zeros(60)),
    # The clock stood still, and a reset is no gap.
    ([0.0, 0.1, 0.1, 0.2, 0.9, 1.0, 1.1], [0, 0, 0, 0, 1, 1, 1])])
def test_whole_runs_have_none(times, resets):
    """A good recording would be said to have holes."""
    assert find_gaps(np.array(times, float), np.array(resets, float)) == []


def test_everything_is_counted(known):
    """The demo would print the figures of another run."""
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


def test_a_run_stepped_while_paused_has_no_pace(known):
    """The cloth would seem to have run at 0 times real time."""
    summary = replace(summarise(Recording(known.folder)), real_time_factor=0.0)
    assert summary_lines(summary)['real-time factor'] == 'none recorded while running'


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


@pytest.fixture
def summary(known):
    """Return the summary of the known recording."""
    return summarise(Recording(known.folder))


def test_what_is_unknown_is_said_to_be(summary):
    """A user would read nan, or a zero that nobody measured."""
    lines = summary_lines(replace(
        summary, dt=math.nan, substeps=math.nan, last_energy=math.nan, device='', rows=0))
    assert lines['dt'] == 'unknown s in unknown substeps'
    assert 'unknown J at the end' in lines['total energy']
    assert lines['device'] == lines['cloth'] == 'not recorded'


def test_parts_that_a_run_has_are_told(summary):
    """Solver, constraints, switches and gaps would have to be looked for in the plots."""
    assert not {
        'solver', 'constraints', 'listed edges', 'strain limit', 'limit tolerance', 'lengths',
        'settling', 'stalled pins', 'mode switches', 'gaps', 'problems',
    } & set(summary_lines(summary))
    lines = summary_lines(replace(
        summary, solver_iterations=12.0, solver_residual=1e-3, solver_missed=4, most_active=7.0,
        most_listed=40.0, strain_over_bound=1.125, limit_unreached=5,
        lengths_lost=3, settling=4, settling_work=1.25, stalled=2,
        switches=[(1.5, 'adaptive', 'constraint')],
        gaps=[(float(n), n + 0.5) for n in range(6)], problems=['a is truncated']))
    assert lines['solver'].startswith('at most 12 iterations, worst residual 0.001, 4 frames')
    assert lines['constraints'] == 'at most 7 active'
    assert lines['listed edges'] == 'at most 40 in a substep'
    assert lines['strain limit'] == 'at most 1.12 times the limit'
    assert lines['limit tolerance'] == 'not reached in 5 frames'
    assert lines['lengths'] == 'far off in 3 frames'
    assert lines['settling'] == 'in 4 frames, by a limit that did 1.25 J of work'
    assert lines['stalled pins'] == 'in 2 frames'
    assert lines['mode switches'] == 'constraint at 1.5 s'
    assert lines['gaps'].startswith('0 to 0.5 s, ') and lines['gaps'].endswith(' and 2 more')
    assert lines['problems'] == 'a is truncated'


def test_the_table_has_a_line_for_each_part(summary):
    """A long value would push the next one out of sight."""
    lines = summary_lines(summary)
    assert [row.split()[0] for row in text_table(lines).splitlines()] == [
        name.split()[0] for name in lines]
