# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Two recordings, node by node."""

from cloth_sim_ros.analysis.comparison import compare
from cloth_sim_ros.analysis.comparison import comparison_lines
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.messages.frame import PointsMessage
from cloth_sim_ros.messages.frame import stats_message
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.scene import Scene
from cut_scene import CUT
from cut_scene import cut_snapshot
from made_snapshot import make_snapshot
import numpy as np
import pytest
from rclpy.serialization import serialize_message


@pytest.fixture
def recorded(tmp_path):
    """Return a function that records frames at ``times``, each node moved by ``offset(time)``."""

    def make(name, times, offset=lambda time: (0.0, 0.0, 0.0), keys=('points', 'stats'), rows=4):
        recorder = Recorder(tmp_path, name)
        for time in times:
            # Positions that float32 holds, so that distances are exact.
            snapshot = make_snapshot(
                rows, 3, time=time, max_strain=0.25 + time, kinetic_energy=1.0)
            for axis, moved in zip('xyz', offset(time)):
                snapshot.records[axis] = np.round(snapshot.records[axis] * 64) / 64 + moved
            data = {
                'points': PointsMessage(rows, 3, 'world').serialise(snapshot),
                'stats': serialize_message(stats_message(snapshot, 'world'))}
            for key in keys:
                recorder.write(key, data[key], time)
        recorder.close()
        return Recording(tmp_path / name)

    return make


def test_a_known_shift_is_found(recorded):
    """Distances would be of other nodes, axes or times."""
    times = np.arange(6) / 8
    result = compare(
        recorded('a', times), recorded('b', times, lambda time: (3 * time, 0.0, 4 * time)))
    np.testing.assert_array_equal(result.times, times)
    np.testing.assert_allclose(result.rms_distance, 5 * times)
    np.testing.assert_allclose(result.max_distance, 5 * times)
    assert (result.first, result.second, result.unmatched) == ('a', 'b', (0, 0))
    assert not result.identical


def test_the_root_mean_square_is_that_of_all_nodes(recorded):
    """One node that is far off would count as all of them, or not at all."""
    times = [0.0]
    moved = np.zeros((4, 3))
    moved[2, 1] = 2.0
    result = compare(recorded('a', times), recorded('b', times, lambda _: (0.0, moved, 0.0)))
    assert result.rms_distance[0] == pytest.approx(np.sqrt(2.0**2 / 12))
    assert result.max_distance[0] == pytest.approx(2.0)


def test_only_common_times_are_compared(recorded):
    """Frames of other moments would be taken for differences."""
    fifty, sixty = np.arange(51) / 50, np.round(np.arange(61) / 60, 9)
    result = compare(recorded('a', fifty), recorded('b', sixty))
    np.testing.assert_allclose(result.times, np.arange(11) / 10)
    assert result.unmatched == (40, 50)
    assert result.identical
    np.testing.assert_allclose(result.strain_difference, 0.0, atol=1e-8)


def test_differences_are_second_minus_first(recorded):
    """A cloth that stretches more would be said to stretch less."""
    a = recorded('a', [0.0, 0.5])
    late = recorded('b', [0.5, 1.0])
    result = compare(a, late)
    assert result.times.tolist() == [0.5]
    assert result.energy_difference[0] == 0.0
    assert comparison_lines(result)['matched'] == (
        '1 frames from 0.5 to 0.5 s; 1 and 1 are in only one of them')


@pytest.mark.parametrize('keys', [('points',), ('stats',)])
def test_what_both_have_is_compared(recorded, keys):
    """Recordings with a part of the topics could not be compared at all."""
    result = compare(recorded('a', [0.0, 0.5]), recorded('b', [0.0, 0.5], keys=keys))
    assert len(result.times) == 2
    assert np.isfinite(result.rms_distance).all() == ('points' in keys)
    assert np.isfinite(result.energy_difference).all() == ('stats' in keys)
    lines = comparison_lines(result)
    assert ('unknown' in lines['total energy']) == ('stats' not in keys)
    assert ('unknown' in lines['node distance']) == ('points' not in keys)


def test_what_cannot_be_compared_is_refused(recorded):
    """A user would get an empty table, or nodes compared with others than their own."""
    a = recorded('a', [0.0, 0.5])
    with pytest.raises(ClothSimError, match='4 x 3 nodes and .*b has 5 x 3 nodes.*give'):
        compare(a, recorded('b', [0.0], rows=5))
    with pytest.raises(ClothSimError, match='no frames at common simulated times: record'):
        compare(a, recorded('c', [0.25, 0.75]))


def test_times_go_on_over_a_reset(known):
    """What came after a reset would be compared with what was before."""
    result = compare(Recording(known.folder), Recording(known.folder))
    assert result.identical and result.unmatched == (0, 0)
    assert result.times[-1] == pytest.approx(0.48)


def test_cloths_of_other_shapes_are_refused(recorded, tmp_path):
    """Nodes would be compared with places where there is none."""
    scene = Scene(CUT)
    paths = []
    for name, values in (('disc', CUT), ('ring', {**CUT, 'shape.disc': 0.3})):
        recorder = Recorder(tmp_path, name)
        message = PointsMessage(scene.rows, scene.cols, 'world', is_dense=False)
        recorder.write('points', message.serialise(cut_snapshot(Scene(values))), 1.25)
        recorder.close()
        paths.append(tmp_path / name)
    with pytest.raises(ClothSimError, match='different shapes'):
        compare(*map(Recording, paths))
    same = compare(Recording(paths[0]), Recording(paths[0]))
    assert same.identical and same.max_distance.tolist() == [0.0]
