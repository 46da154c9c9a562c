# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A sheet of runs, of which some blow up."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.summary import RunOutcome
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.rendering.picture import write_run_sheet
from cloth_sim_ros.sim.errors import ClothSimError
from made_snapshot import make_snapshot
import numpy as np
from PIL import Image
import pytest

SIDE = 6
TIMES = (0.0, 0.5, 1.0)


@pytest.fixture
def recorded(tmp_path):
    """Return a function that records a square which is blown up by a factor a frame."""

    def record(name, factor, strain):
        recorder = Recorder(tmp_path, name, 'cloth_sim')
        points = PointsMessage(SIDE, SIDE, 'world')
        for number, time in enumerate(TIMES):
            made = make_snapshot(SIDE, SIDE, time=time)
            size = factor**number
            made.records['x'] = size * np.linspace(-0.5, 0.5, SIDE)
            made.records['y'] = size * np.linspace(0.5, -0.5, SIDE)[:, None]
            made.records['z'] = 0.0
            for axis, part in zip(('normal_x', 'normal_y', 'normal_z'), (0.0, 0.0, 1.0)):
                made.records[axis] = part
            made.records['strain'] = strain * number
            recorder.write('points', points.serialise(made), time)
        recorder.close()
        return Recording(tmp_path / name)

    return record


def drawn(path, runs):
    """Return the pixels of a sheet of ``runs``."""
    write_run_sheet(path, runs, TIMES, 'A title')
    return np.asarray(Image.open(path))


def test_blow_up_does_not_change_the_view(recorded, tmp_path):
    """A cloth of the size of a planet would make dots of all others."""
    calm = ('run', recorded('calm', 1.0, 0.01), RunOutcome(end=1.0))
    torn = ('run', recorded('torn', 1e6, 1e5), RunOutcome(end=1.0))
    alone = drawn(tmp_path / 'alone.png', [calm, calm])
    both = drawn(tmp_path / 'both.png', [calm, torn])
    assert alone.shape == both.shape
    # The first row, without its label and the colour bar, which shows the larger strain.
    upper, right = alone.shape[0] // 3, alone.shape[1] * 4 // 5
    assert np.array_equal(alone[:upper, :right], both[:upper, :right])


def test_what_comes_after_a_stop_is_words(recorded, tmp_path):
    """The last cloth before a blow-up would be shown at times it has not come to."""
    recording = recorded('calm', 1.0, 0.01)
    whole = ('run', recording, RunOutcome(end=1.0))
    stopped = ('run', recording, RunOutcome(end=0.6, stopped=True, stability_margin=1.2))
    one, other = (drawn(tmp_path / f'{number}.png', [whole, run])
                  for number, run in enumerate((whole, stopped)))
    differs = np.argwhere((one != other).any(axis=2))
    low, high = differs.min(axis=0), differs.max(axis=0)
    # The third panel of the second row alone.
    assert low[0] > one.shape[0] * 2 // 5
    assert low[1] > one.shape[1] // 2
    panel = other[low[0]:high[0], low[1]:high[1]]
    # It is grey on white.
    assert np.all(np.ptp(panel.astype(int), axis=2) == 0)
    assert panel.min() < 100


def test_a_file_that_cannot_be_written_is_told(recorded, tmp_path):
    """A wrong path would end in a traceback."""
    run = ('run', recorded('calm', 1.0, 0.01), RunOutcome(end=1.0))
    with pytest.raises(ClothSimError, match='cannot be written'):
        write_run_sheet(tmp_path / 'none' / 'sheet.png', [run], TIMES, '')
