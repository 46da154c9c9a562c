# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recorded run is made again with the loads and block it had, whatever the device has since."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.node.parameters import FIELDS
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.resimulation.recorded_run import RecordedRun
from cloth_sim_ros.resimulation.rerun import Rerun
from cloth_sim_ros.sim.device.tuning import Choice
from made_again import assert_same
from made_again import Director
from made_again import made_again
import pytest
from rclpy.serialization import serialize_message
from springs import SPRINGS
from tuned_device import tune_device

VALUES = {**SPRINGS, 'rows': 8, 'cols': 9, 'start.jitter': 0.05}
FIRST, SECOND = Choice('storage', 2), Choice('texture', 1)


@pytest.fixture
def tune(monkeypatch, tmp_path):
    """Return a function that tunes this device."""
    context = Context(single_thread=True)
    device, driver = context.device, context.version
    context.close()
    return lambda choice: tune_device(
        monkeypatch, tmp_path / 'cache', device, driver, {16: choice})


@pytest.fixture
def recorded(tune, tmp_path):
    """Record a run as a device was tuned, tune it otherwise and return the recording."""
    tune(FIRST)
    with Director(tmp_path, VALUES) as director:
        assert director.simulation.layout.choice == FIRST
        director.step(5)
        director.step(5)
    tune(SECOND)
    return director.path


def test_it_has_what_it_had_and_the_same_bits(recorded):
    """On a device that rounds otherwise with another block, no recording could be made again."""
    assert_same(recorded, 3)
    with made_again(recorded) as rerun:
        assert rerun.simulation.layout.choice == FIRST
        assert rerun.changed == ()


@pytest.mark.parametrize(('changes', 'choice'), [
    ({'block': 1}, Choice('storage', 1)), ({'layout': 'paper'}, Choice('storage', 1))], ids=str)
def test_another_choice_can_be_asked_for(recorded, changes, choice):
    """What was chosen for one layout would be refused by the other."""
    with made_again(recorded, **changes) as rerun:
        assert rerun.simulation.layout.choice == choice
        assert set(changes) <= set(rerun.changed)


def test_what_an_older_recording_left_open_is_built_in(tune, tmp_path):
    """A recording from before the device was tuned would get other bits."""
    recorder = Recorder(tmp_path, 'old')
    recorder.write('inputs/parameters', serialize_message(
        parameters_message(VALUES, FIELDS, 0.0, 'cloth_sim')), 0.0)
    recorder.close()
    run = RecordedRun(Recording(recorder.path, 'cloth_sim'))
    plain = Rerun(run)
    choice = plain.simulation.layout.choice
    plain.close()
    tune(FIRST if choice != FIRST else SECOND)
    tuned = Rerun(run)
    assert tuned.simulation.layout.choice == choice
    tuned.close()
