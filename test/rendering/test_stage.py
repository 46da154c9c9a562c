# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a picture says of its sources."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.source import StateSource
from cloth_sim_ros.rendering.stage import labels_of
from cloth_sim_ros.rendering.stage import note_of
from cloth_sim_ros.rendering.stage import Style
from cloth_sim_ros.rendering.stage import title_of
import numpy as np
import pytest


@pytest.fixture
def sources(known, tmp_path, flat):
    """Return a recording and a state file without strain."""
    np.savez(tmp_path / 'last.npz', positions=flat().positions)
    return [RecordingSource(Recording(known.folder)), StateSource(tmp_path / 'last.npz')]


def test_the_title_tells_size_and_modes(sources, flat):
    """A picture could not be told from that of another run."""
    assert title_of(sources[:1], [flat(4, 5)]) == '4 x 5 nodes, mass_spring'
    assert title_of(sources, [flat(4, 5)]) == '4 x 5 nodes'
    assert title_of(sources, [flat(4, 5), flat(6, 5)]) == ''


def test_rows_are_named_by_folder_and_mode_or_as_asked(sources):
    """A reader would not know which row is which."""
    assert labels_of(sources, Style()) == ['known (mass_spring)', 'last']
    assert labels_of(sources, Style(labels=('one', 'two'))) == ['one', 'two']


def test_the_note_tells_what_is_not_drawn(sources):
    """A cloth without pins and strain would be taken for one that has none."""
    assert note_of(sources) == (
        'simulated on a device; last lacks strain and pins and limits: not drawn')
    assert note_of(sources[:1]) == 'simulated on a device'
