# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Recordings as a source of pictures."""

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.rendering.recording_source import RecordingSource
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
import pytest


def test_it_tells_what_was_recorded(known):
    """A sheet would name another mode or device."""
    source = RecordingSource(Recording(known.folder))
    assert (source.name, source.modes, source.device) == ('known', ['mass_spring'], 'a device')
    assert source.missing == []
    assert sum(1 for _ in source.frames()) == len(known.records)
    assert [frame.time for frame in source.frames_at([0.1, 0.2])] == pytest.approx([0.1, 0.2])
    assert len(source.default_times(4)) == 4


def test_a_recording_without_frames_is_refused(tmp_path):
    """A video would be empty, and nobody told why."""
    Recorder(tmp_path, 'empty', 'cloth_sim').close()
    with pytest.raises(ClothSimError, match='contains no messages'):
        list(RecordingSource(Recording(tmp_path / 'empty')).frames())
