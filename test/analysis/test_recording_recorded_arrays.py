# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a recording as arrays."""

from pathlib import Path
import sys

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros import ClothSimError
from cloth_sim_ros import Recording
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import SimulationRecorder
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.summary import summarise
from cloth_sim_ros.analysis.summary import summary_lines
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from foreign_bag import write_bag
from made_cloud import make_cloud
import numpy as np
import pandas
import pytest
from rclpy.serialization import deserialize_message
from recorded import Recorded
from sensor_msgs.msg import PointCloud2

EXAMPLE = Path(__file__).resolve().parents[2] / 'bags' / 'example'


@pytest.fixture(scope='module')
def recording():
    """Open the shipped recording."""
    return Recording(EXAMPLE)


def test_points_are_those_of_the_messages(recording):
    """Positions would be of other nodes, frames or fields."""
    points = recording.arrays('points')
    messages = Recorded(EXAMPLE).messages('points')
    rows, cols = messages[0].height, messages[0].width
    assert points['positions'].shape == (len(messages), rows, cols, 3)
    assert points['positions'].dtype == np.float32
    last = np.frombuffer(messages[-1].data, np.float32).reshape(rows, cols, -1)
    names = [field.name for field in messages[-1].fields]
    for name, first in (('positions', 'x'), ('velocities', 'vx'), ('normals', 'normal_x')):
        place = names.index(first)
        np.testing.assert_array_equal(points[name][-1], last[..., place:place + 3])
    np.testing.assert_array_equal(points['strain'][-1], last[..., names.index('strain')])
    assert np.all(np.diff(points['time']) > 0.0)
    held = (points['flags'][0] & FLAG_PINNED) != 0
    assert held.any() and np.all(points['velocities'][0][held] == 0.0)


def test_stats_are_the_columns_of_the_table(recording):
    """A table made in Python would differ from that of `cloth_sim analyze`."""
    stats, columns = recording.arrays('stats'), Run(recording).columns
    for name in ('time', 'max_strain', 'total_energy', 'substeps'):
        np.testing.assert_array_equal(stats[name], columns[name])
    assert 'header' not in stats and not any(name.startswith('_') for name in stats)


def test_stats_are_a_table_of_pandas(recording):
    """A user's first line in pandas would need loops and lists."""
    table = pandas.DataFrame(recording.arrays('stats')).set_index('time')
    assert len(table) == recording.count('stats')
    assert table['max_strain'].idxmax() in table.index


def test_inputs_have_their_vectors_and_words(recording):
    """What was done to the cloth could not be set beside what it did."""
    pushes = recording.arrays('inputs/push')
    count = recording.count('inputs/push')
    assert count and all(pushes[f'force.{axis}'].shape == (count,) for axis in 'xyz')
    assert set(pushes['region']) <= {'all', 'sphere'} and 'ALL' not in pushes
    assert recording.arrays('inputs/mode')['mode'][0] == 'mass_spring'


def test_missing_topic_error_lists_the_topics(recording):
    """A misspelt topic would give empty arrays."""
    with pytest.raises(ClothSimError, match='no topic point .*: choose one of .*points'):
        recording.arrays('point')


def test_clouds_of_two_sizes_are_refused(tmp_path):
    """They have no common array."""
    clouds = [deserialize_message(make_cloud(rows, 3, 0)[0], PointCloud2) for rows in (2, 4)]
    bag = write_bag(tmp_path / 'bag', [('/cloth_sim/points', cloud) for cloud in clouds])
    with pytest.raises(ClothSimError, match='4 x 3 nodes at 0 s follows one of 2 x 3'):
        Recording(bag).arrays('points')


def test_a_topic_without_messages_gives_empty_arrays(tmp_path):
    """A recording that was stopped at once would end in an IndexError."""
    bag = write_bag(tmp_path / 'bag', [
        ('/cloth_sim/points', PointCloud2), ('/cloth_sim/stats', ClothStats)])
    for key in ('points', 'stats'):
        arrays = Recording(bag).arrays(key)
        assert len(arrays['time']) == 0


HANDLED = {
    'rows': 6, 'cols': 5, 'pins': ['top_left'], 'start.z': 0.1, 'dt': 0.005, 'air.density': 0.0,
    'colliders.names': ['floor', 'ball'], 'colliders.floor.shape': 'plane',
    'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.05],
    'colliders.ball.position': [0.0, 0.1, 0.0]}


@pytest.fixture(scope='module')
def handled(tmp_path_factory):
    """Return a recording with a pin, a grasp for a while, and colliders; and frames of 4 steps."""
    folder = tmp_path_factory.mktemp('handled')
    with Simulation(Scene(HANDLED)) as cloth, SimulationRecorder(
            cloth, folder, 'run', parameters={'publish.rate': 50.0}) as recorder:
        recorder.advance(0.1)
        cloth.grasp('hand', cloth.positions()[5, 4].astype(float), radius=0.2)
        recorder.advance(0.2)
        cloth.release_grasp('hand')
        recorder.advance(0.1)
    return Recording(recorder.path)


@pytest.mark.parametrize(('key', 'names'), [
    ('grasps/wrenches', {'hand'}), ('grasps/peak_wrenches', {'hand'}),
    ('colliders/wrenches', {'floor', 'ball'})])
def test_wrenches_of_bodies_have_their_names(handled, key, names):
    """Hundreds of forces would stand in a table without a word of what they act on."""
    table = pandas.DataFrame(handled.arrays(key))
    assert len(table) == handled.count(key) and set(table['name']) == names
    kind = key.split('/')[0][:-1]
    assert set(table['frame_id']) == {f'cloth_sim_{kind}_{name}' for name in names}
    assert table['wrench.force.z'].abs().max() > 0.0


def test_each_topic_is_a_flat_table(handled):
    """A user would need loops and lists for the first table."""
    for key in handled.keys() - {'topology', 'markers'}:
        table = handled.frame(key)
        assert isinstance(table, pandas.DataFrame) and len(table) >= handled.count(key)
    points = handled.frame('points')
    assert len(points) == handled.count('points') * 30
    arrays = handled.arrays('points')
    node = points[(points['row'] == 4) & (points['col'] == 2)]
    np.testing.assert_array_equal(node[['x', 'y', 'z']], arrays['positions'][:, 4, 2])
    np.testing.assert_array_equal(node['flags'], arrays['flags'][:, 4, 2])
    pins = handled.frame('pins/wrenches')
    assert set(zip(pins['row'], pins['col'])) == {(0, 0)}


def test_a_table_without_pandas_is_refused(handled, monkeypatch):
    """A machine without pandas would end in a traceback."""
    monkeypatch.setitem(sys.modules, 'pandas', None)
    with pytest.raises(ClothSimError, match='pip install pandas.*Recording.arrays'):
        handled.frame('stats')


def test_a_report_has_the_forces_of_bodies(handled):
    """`cloth_sim analyze` and `cloth_sim info` would be silent about grasps and colliders."""
    run = Run(handled)
    for body in ('grasp_hand', 'collider_floor', 'collider_ball'):
        assert np.nanmax(np.abs(run.columns[f'{body}_force_z'])) > 0.0
    held = np.isfinite(run.columns['grasp_hand_force_x'])
    # Let go at the end of a frame, it has no frame then that it would be given in.
    assert run.columns['time'][held].min() == pytest.approx(0.12)
    assert run.columns['time'][held].max() == pytest.approx(0.3)
    lines = summary_lines(summarise(handled))
    assert lines['grasps'] == 'hand from 0.1 to 0.3 s'


def test_recorded_forces_add_up(handled):
    """The forces of frames of several steps would be those of their last steps."""
    points, given = handled.arrays('points'), np.zeros(3)
    for key in ('pins/wrenches', 'grasps/wrenches', 'colliders/wrenches'):
        table = handled.arrays(key)
        # No body is turned, so that its axes are those of the world.
        later = table['time'] > 0.0
        given += [0.02 * table[f'wrench.force.{axis}'][later].sum() for axis in 'xyz']
    scene = Scene(HANDLED)
    masses = scene.node_mass * scene.node_shares[..., None]
    momentum = np.sum(masses * points['velocities'], axis=(1, 2))
    weight = scene.mass * np.array(scene['gravity'])
    lost = momentum[0] - momentum[-1] + 0.4 * weight
    assert np.abs(given - lost).max() <= 1e-4 * np.linalg.norm(lost)
