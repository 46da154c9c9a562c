# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Sheets as files."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.rendering.picture import draw_picture
from cloth_sim_ros.rendering.picture import write_picture
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.sheet import Layout
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.source import StateSource
from cloth_sim_ros.sim.errors import ClothSimError
from matplotlib.image import imread
import numpy as np
import pytest

SMALL = Style(panel=(120, 90))


@pytest.fixture
def source(known):
    """Return the known recording."""
    return RecordingSource(Recording(known.folder))


@pytest.fixture
def state(tmp_path, flat):
    """Return a state file without strain, with as many nodes as the recording."""
    np.savez(tmp_path / 'state.npz', positions=flat(5, 4).positions)
    return StateSource(tmp_path / 'state.npz')


@pytest.mark.parametrize(('frames', 'rows', 'columns'), [(1, 1, 1), (3, 1, 3), (5, 2, 3)])
def test_each_time_has_its_panel(source, hanging, frames, rows, columns):
    """A panel would be missing, empty, or filled from edge to edge."""
    picture = draw_picture(
        [source], [[hanging(float(number)) for number in range(frames)]], SMALL)
    layout = Layout(rows, columns, SMALL.panel)
    assert picture.shape == (layout.size[1], layout.size[0], 3)
    for number in range(rows * columns):
        left, top = layout.corner(number)
        top += layout.heading
        panel = picture[top:top + 90, left:left + 120].astype(int)
        cloth = (np.ptp(panel, axis=-1) > 25).mean()
        assert 0.1 < cloth < 0.9 if number < frames else cloth == 0.0


def test_several_recordings_have_a_row_each(source, hanging):
    """The rows would have no labels, or be mixed."""
    near, far = hanging(), hanging()
    near.records['strain'], far.records['strain'] = 0.04, 0.0
    style = Style(panel=(120, 90), labels=('stiff', 'soft'))
    picture = draw_picture([source, source], [[near, near], [far, far]], style)
    layout = Layout(2, 2, (120, 90), has_labels=True)
    assert picture.shape == (layout.size[1], layout.size[0], 3)
    panels = []
    for number in range(4):
        left, top = layout.corner(number)
        panels.append(picture[top + layout.heading:top + layout.heading + 90, left:left + 120])
    np.testing.assert_array_equal(panels[0], panels[1])
    np.testing.assert_array_equal(panels[2], panels[3])
    # One camera and one scale: the cloth is in the same place, in other colours.
    assert np.abs(panels[0].astype(int) - panels[2]).max() > 60
    middles = [
        np.argwhere(np.ptp(panel.astype(int), axis=-1) > 10).mean(axis=0)
        for panel in panels[::2]]
    np.testing.assert_allclose(*middles, atol=1.0)
    assert (picture[:, :layout.left] < 128).any()


def test_several_recordings_at_one_time_stand_side_by_side(source, hanging):
    """They would be far from each other, one below the other."""
    picture = draw_picture([source, source], [[hanging()], [hanging()]], SMALL)
    assert picture.shape[1] == Layout(1, 2, SMALL.panel).size[0]


def test_a_recording_is_drawn_by_itself(source, tmp_path):
    """The command of the README would not make a picture."""
    write_picture([source], tmp_path / 'six.png', style=SMALL)
    write_picture([source], tmp_path / 'two.png', times=[0.1, 0.2], style=SMALL)
    six, two = (imread(tmp_path / f'{name}.png') for name in ('six', 'two'))
    assert six.shape[1::-1] == Layout(2, 3, SMALL.panel).size
    assert two.shape[1::-1] == Layout(1, 2, SMALL.panel).size


def test_a_state_is_drawn_once_and_without_a_bar(state, source, tmp_path):
    """The same state would be shown six times, or colours be explained that it has not."""
    write_picture([state], tmp_path / 'one.png', style=SMALL)
    assert imread(tmp_path / 'one.png').shape[1::-1] == Layout(
        1, 1, SMALL.panel, has_bar=False).size
    # Beside a recording it fills its row.
    write_picture([source, state], tmp_path / 'rows.png', times=[0.1, 0.2], style=SMALL)
    assert imread(tmp_path / 'rows.png').shape[1::-1] == Layout(
        2, 2, SMALL.panel, has_labels=True).size


def test_a_file_that_cannot_be_written_is_told(state, tmp_path):
    """A user would get a traceback for a mistyped folder."""
    with pytest.raises(ClothSimError, match='nowhere.*cannot be written'):
        write_picture([state], tmp_path / 'nowhere' / 'cloth.png', style=SMALL)
