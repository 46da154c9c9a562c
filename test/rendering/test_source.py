# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Frames and states come as they were recorded or written."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.inputs import parameters_message
from cloth_sim_ros.messages.inputs import serialise_parameter_event
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.rendering.source import nearest_frames
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.source import StateSource
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import SetMode
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cut_scene import CUT
from cut_scene import cut_snapshot
from hypothesis import given
from hypothesis import strategies
import numpy as np
import pytest
from rclpy.serialization import serialize_message

TIMES = strategies.lists(strategies.integers(0, 1000), min_size=1, max_size=20, unique=True)


@given(TIMES, TIMES)
def test_each_time_gets_the_nearest_frame(given_times, wanted):
    """A video would lag behind its clock, or skip a part."""
    frames = [Frame(float(time), np.zeros(0)) for time in sorted(given_times)]
    wanted = sorted(wanted)
    found = list(nearest_frames(iter(frames), wanted))
    assert len(found) == len(wanted)
    for time, frame in zip(wanted, found):
        assert abs(frame.time - time) == min(abs(other.time - time) for other in frames)


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


@pytest.mark.parametrize('shape', ['sphere', 'torus'])
def test_colliders_that_are_not_known_are_named(tmp_path, shape):
    """A cloth would hang in the air without a note on what it lies on."""
    values = {
        'colliders.names': ['ball'], 'colliders.ball.shape': 'sphere',
        'colliders.ball.size': [0.1]}
    message = parameters_message(
        Scene(values).values, all_fields(values), 0.0, 'cloth_sim')
    for parameter in message.new_parameters:
        if parameter.name == 'colliders.ball.shape':
            parameter.value.string_value = shape
    recorder = Recorder(tmp_path, 'run', 'cloth_sim')
    recorder.write('inputs/parameters', serialise_parameter_event(message), 0.0)
    key, mode = input_message(SetMode('constraint'), 0.0, 'world')
    recorder.write(key, serialize_message(mode), 0.0)
    recorder.close()
    source = RecordingSource(Recording(tmp_path / 'run'))
    assert source.missing == ([] if shape == 'sphere' else ['colliders'])


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


def test_a_state_of_a_cut_cloth_is_drawn(tmp_path):
    """The end of a run could not be looked at, or its border be lit from elsewhere."""
    snapshot = cut_snapshot(Scene(CUT))
    arrays = {'positions': snapshot.positions, 'flags': snapshot.flags}
    np.savez(tmp_path / 'state.npz', **arrays)
    frame, = StateSource(tmp_path / 'state.npz').frames()
    assert np.array_equal(frame.present, Scene(CUT).present_nodes)
    np.testing.assert_array_equal(
        frame.normals[frame.present], np.broadcast_to((0, 0, 1), (frame.present.sum(), 3)))
    arrays['positions'] = snapshot.positions.copy()
    arrays['positions'][tuple(np.argwhere(frame.present)[3])] = np.nan
    np.savez(tmp_path / 'state.npz', **arrays)
    with pytest.raises(ClothSimError, match='finite numbers'):
        StateSource(tmp_path / 'state.npz')
