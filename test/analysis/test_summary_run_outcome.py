# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run came to, by its recording."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.summary import outcome_table
from cloth_sim_ros.analysis.summary import RunOutcome
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.messages.state import state_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from made_snapshot import make_snapshot
import pytest
from rclpy.serialization import serialize_message


@pytest.fixture
def recording(tmp_path):
    """Record a start and three frames of 10 steps, the second the worst; then a stop."""
    recorder = Recorder(tmp_path, 'bag', 'cloth_sim')
    points = PointsMessage(2, 2, 'world')
    for number, (strain, energy, substeps) in enumerate(
            [(0.0, 0.0, 1), (0.1, 5.0, 2), (0.3, 4.0, 6), (0.2, 3.0, 4)]):
        made = make_snapshot(
            2, 2, time=0.1 * number, steps=10 * number, dt=0.01, substeps=substeps,
            max_strain=strain, kinetic_energy=energy, stability_margin=1.0 / substeps)
        recorder.write('points', points.serialise(made), made.time)
        stats = stats_message(made, 'world', step_wall_time=2e-3 * number)
        recorder.write('stats', serialize_message(stats), made.time)
    recorder.write('state', serialize_message(state_message(
        frame_id='world', sim_time=0.3, mode='adaptive', available_modes=['adaptive'],
        run_state='stopped', rows=2, cols=2, dt=0.01, substeps=4, stability_limit=0.01,
        device='a device')), 0.3)
    recorder.close()
    return Recording(tmp_path / 'bag')


def test_peaks_are_those_of_all_frames(recording):
    """A peak would be missed, or steps counted twice."""
    outcome = RunOutcome.of(Run(recording))
    assert outcome.end == pytest.approx(0.3)
    assert outcome.dt == 0.01
    assert outcome.device == 'a device'
    assert outcome.max_strain == pytest.approx(0.3)
    assert outcome.kinetic_energy == 5.0
    assert outcome.substeps == 4.0
    assert outcome.stability_margin == 1.0
    assert outcome.wall_seconds == pytest.approx(10 * (2e-3 + 4e-3 + 6e-3))


def test_a_stop_is_told(recording):
    """A run that broke off would look like one that came to its end."""
    assert RunOutcome.of(Run(recording)).stopped


def test_a_recording_without_frames_is_refused(tmp_path):
    """A row of zeros would stand in the table."""
    Recorder(tmp_path, 'empty', 'cloth_sim').close()
    with pytest.raises(ClothSimError, match='contains no messages'):
        Run(Recording(tmp_path / 'empty'))


def test_table_marks_strain_beyond_the_limit():
    """Springs would be held to a limit they lack, or a strain of 10 % at its limit be a fault."""
    outcome = RunOutcome(end=0.3, dt=0.01, substeps=2.0, max_strain=0.105, stopped=True)
    _, _, springs, hard, limited = outcome_table([
        ('springs', outcome, None), ('hard', outcome, 0.0), ('limited', outcome, 0.1),
    ]).splitlines()
    assert springs.split(' | ')[3:5] == ['10.5 %', '-']
    assert hard.split(' | ')[3:5] == ['10.5 %', '10.5 %']
    assert limited.split(' | ')[3:5] == ['10.5 %', '0.5 %']
    assert 'not finite after 0.3 s' in springs
