# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The topics of a recording as arrays."""

from pathlib import Path

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros import ClothSimError
from cloth_sim_ros import Recording
from cloth_sim_ros.analysis.run import Run
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
    assert count and pushes['force'].shape == (count, 3)
    assert set(pushes['region']) <= {'all', 'sphere'} and 'ALL' not in pushes
    assert recording.arrays('inputs/mode')['mode'][0] == 'mass_spring'


def test_a_topic_that_is_not_there_is_told_with_those_that_are(recording):
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
