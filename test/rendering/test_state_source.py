# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""State files as a source of pictures."""

from cloth_sim_ros.rendering.state_source import StateSource
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
import numpy as np
import pytest


@pytest.fixture
def state(flat):
    """Return the arrays of a state file."""
    frame = flat(4, 5)
    flags = np.zeros((4, 5), np.uint32)
    flags[0, 0] = FLAG_PINNED
    return {
        'positions': frame.positions.astype(np.float32), 'time': np.array(1.5),
        'velocities': np.zeros((4, 5, 3)), 'strain': frame.strain, 'flags': flags}


def test_all_of_it_is_taken(state, tmp_path):
    """The picture would show another cloth than the file holds."""
    np.savez(tmp_path / 'state.npz', **state)
    source = StateSource(tmp_path / 'state.npz')
    frame, = source.frames()
    assert source.name == 'state' and source.missing == []
    assert frame.time == 1.5 and source.default_times(6) == [1.5]
    np.testing.assert_array_equal(frame.positions, state['positions'])
    np.testing.assert_array_equal(frame.strain, state['strain'])
    assert frame.pinned[0, 0] and frame.pinned.sum() == 1
    np.testing.assert_allclose(frame.normals, np.broadcast_to((0, 0, 1), (4, 5, 3)))
    assert [each.time for each in source.frames_at([0.0, 9.0])] == [1.5, 1.5]


def test_what_an_older_file_lacks_is_told(state, tmp_path):
    """A state of an earlier version could not be drawn, or would seem to have no strain."""
    del state['strain'], state['flags'], state['time']
    np.savez(tmp_path / 'old.npz', **state)
    source = StateSource(tmp_path / 'old.npz')
    frame, = source.frames()
    assert source.missing == ['strain', 'pins and limits']
    assert np.isnan(frame.strain).all() and not frame.pinned.any()


@pytest.mark.parametrize(('change', 'rule'), [
    ({'positions': np.zeros((4, 5))}, r'shape \(4, 5\), not \(rows, cols, 3\)'),
    ({'positions': np.full((4, 5, 3), np.nan)}, 'not all finite'),
    ({'positions': np.zeros((4, 5, 3), 'U1')}, 'not all finite'),
    ({'strain': np.zeros((2, 2))}, r'strain in .* has the shape \(2, 2\), the cloth \(4, 5\)'),
])
def test_what_is_no_cloth_is_refused(state, tmp_path, change, rule):
    """A picture of nonsense would be drawn, or a traceback shown."""
    np.savez(tmp_path / 'wrong.npz', **{**state, **change})
    with pytest.raises(ClothSimError, match=rule):
        StateSource(tmp_path / 'wrong.npz')


def test_other_files_are_refused(tmp_path):
    """A user would get a traceback for a mistyped file."""
    np.savez(tmp_path / 'other.npz', something=np.zeros(3))
    (tmp_path / 'text.npz').write_text('no archive')
    np.save(tmp_path / 'array.npy', np.zeros(3))
    (tmp_path / 'array.npy').rename(tmp_path / 'array.npz')
    for name, rule in (
            ('other', 'holds no positions'), ('text', 'is not a state file'),
            ('array', 'is not a state file'), ('none', 'there is no state file')):
        with pytest.raises(ClothSimError, match=rule):
            StateSource(tmp_path / f'{name}.npz')
