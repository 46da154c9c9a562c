# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Reading what was recorded, whole or cut off."""

from pathlib import Path
import shutil
from types import SimpleNamespace

from cloth_sim_ros.analysis.recording import find_node
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.recording import SteadyTime
from cloth_sim_ros.analysis.recording import TYPES
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_messages import BagTopic
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from made_cloud import make_cloud
import numpy as np
import pytest
from rosbags.interfaces import MessageDefinition
from rosbags.interfaces import MessageDefinitionFormat

CLOUD = 'sensor_msgs/msg/PointCloud2'
STATS = 'cloth_sim_interfaces/msg/ClothStats'


def test_it_goes_on_where_a_reset_put_the_clock_back():
    """What came after a reset would be mixed with what was before."""
    time = SteadyTime()
    stamps = [(0, 0), (1, 500000000), (0, 0), (2, 0), (0, 250000000)]
    read = [time.read(SimpleNamespace(sec=sec, nanosec=nanosec)) for sec, nanosec in stamps]
    assert read == [0.0, 1.5, 1.5, 3.5, 3.75]


def test_it_begins_where_the_recording_begins():
    """A recording that was started late would seem to start at 0."""
    assert SteadyTime().read(SimpleNamespace(sec=7, nanosec=0)) == 7.0


def test_a_late_message_is_no_reset():
    """Clouds that came after the figures of the next frame would shift all that follow."""
    time = SteadyTime()
    given = [
        ('stats', 0.0), ('points', 0.0), ('stats', 0.02), ('stats', 0.04), ('points', 0.02),
        ('points', 0.04), ('push', 0.02), ('stats', 0.06)]
    read = [time.read(_stamp(at), topic) for topic, at in given]
    assert read == pytest.approx([at for _, at in given])


def test_every_topic_learns_of_a_reset():
    """A push after a reset would be shown before it, where its topic is seldom sent."""
    time = SteadyTime()
    given = [
        ('push', 0.5), ('points', 5.0), ('stats', 4.98), ('points', 0.0), ('stats', 5.0),
        ('points', 0.02), ('stats', 0.0), ('push', 1.0), ('points', 1.0)]
    read = [time.read(_stamp(at), topic) for topic, at in given]
    assert read == pytest.approx([0.5, 5.0, 4.98, 5.0, 5.0, 5.02, 5.0, 6.0, 6.0])


def _stamp(seconds):
    return SimpleNamespace(sec=int(seconds), nanosec=round(seconds % 1.0 * 1e9))


def find(*topics):
    """Return the node of a bag with ``topics``, each a name and a type."""
    none = MessageDefinition(MessageDefinitionFormat.NONE, '')
    return find_node([BagTopic(*topic, (), 1, none) for topic in topics], Path('bag'))


def test_types_are_those_of_the_node():
    """A topic would be passed over as another program's."""
    assert TYPES == {
        key: topic.type_name for key, topic in TOPICS.items() if not topic.is_global}


def test_any_topic_of_ours_names_the_node():
    """A bag of a node with a namespace, or without points, would need --node."""
    assert find(('/cloth_sim/stats', STATS)) == '/cloth_sim'
    assert find(('/left/cloth/points', CLOUD), ('/rosout', 'a')) == '/left/cloth'
    assert find(('/a/inputs/push', 'cloth_sim_interfaces/msg/Push')) == '/a'


def test_points_of_other_programs_do_not_count_beside_ours():
    """A bag with a laser scanner in it would need --node."""
    assert find(('/laser/points', CLOUD), ('/a/stats', STATS), ('/a/points', CLOUD)) == '/a'


def test_other_types_do_not_count():
    """A bag of another program would be taken for a cloth."""
    with pytest.raises(ClothSimError, match='bag holds no frame of a cloth_sim node'):
        find(('/cloth_sim/points', 'std_msgs/msg/String'), ('/a/stats', CLOUD))


def test_several_nodes_are_not_mixed():
    """Two cloths in one bag would be read as one, or one of them without a word."""
    with pytest.raises(ClothSimError, match='several nodes .*/a, /b.*--node'):
        find(('/b/stats', STATS), ('/a/stats', STATS))


def test_messages_come_as_they_were_recorded(known):
    """A study would work on other numbers than the simulation made, or in another order."""
    clouds = [entry.message for entry in Recording(known.folder).entries('points')]
    assert len(clouds) == len(known.records)
    for cloud, records in zip(clouds, known.records):
        assert bytes(cloud.data) == records.tobytes()


def test_only_the_topics_asked_for_come(known):
    """A reader would have to sort out, and wait for, what it never asked for."""
    keys = {entry.key for entry in Recording(known.folder).entries('stats', 'inputs/push')}
    assert keys == {'stats', 'inputs/push'}


def test_time_goes_on_over_a_reset(known):
    """Plots would fold back on themselves at a reset."""
    times = [entry.time for entry in Recording(known.folder).entries('points')]
    assert times[0] == 0.0
    assert np.all(np.diff(times) >= 0.0)
    assert times[-1] == pytest.approx(0.38 + 0.1)


def test_a_file_is_as_good_as_its_folder(known):
    """Half of what a user may point at would be refused."""
    file, = known.folder.glob('*.mcap')
    assert len(list(Recording(file).entries('points'))) == len(known.records)


def test_another_node_can_be_read(tmp_path):
    """A recording of a node with a namespace could not be read."""
    recorder = Recorder(tmp_path, 'other', '/left/cloth')
    recorder.write('points', make_cloud(2, 2, 0)[0], 0.0)
    recorder.close()
    assert list(Recording(tmp_path / 'other', 'cloth_sim').entries('points')) == []
    assert len(list(Recording(tmp_path / 'other', '/left/cloth').entries('points'))) == 1
    assert Recording(tmp_path / 'other').node == '/left/cloth'


def test_raw_messages_of_all_topics_can_be_had(known):
    """A player would need a reader of its own."""
    recording = Recording(known.folder)
    raw = list(recording.raw_messages())
    assert {message.topic for message in raw} == {topic.name for topic in recording.topics}
    assert len(raw) == sum(topic.count for topic in recording.topics)
    assert [message.time for message in raw] == sorted(message.time for message in raw)
    stats = [message for message in raw if message.topic == '/cloth_sim/stats']
    decoded = [recording.decode(message).max_strain for message in stats]
    assert decoded == [entry.message.max_strain for entry in recording.entries('stats')]
    assert stats[0].type_name == 'cloth_sim_interfaces/msg/ClothStats'


@pytest.mark.parametrize('share', [0.3, 0.7, 0.99])
def test_a_recording_that_was_cut_off_is_read_up_to_there(tmp_path, share):
    """The recording of a crashed or killed run would be lost."""
    side, count = 64, 30
    recorder = Recorder(tmp_path, 'whole', 'cloth_sim')
    clouds = [make_cloud(side, side, number) for number in range(count)]
    for number, (data, _) in enumerate(clouds):
        recorder.write('points', data, number / 50)
    recorder.close()
    whole, = (tmp_path / 'whole').glob('*.mcap')
    cut = tmp_path / 'cut.mcap'
    cut.write_bytes(whole.read_bytes()[:int(share * whole.stat().st_size)])
    read = list(Recording(cut).entries('points'))
    # Chunks of 1 MiB hold 5 to 6 of these clouds.
    assert len(read) >= share * count - 7
    for entry, (_, records) in zip(read, clouds):
        stored = np.frombuffer(entry.message.data, POINT_DTYPE)
        np.testing.assert_array_equal(stored.view(np.uint32), records.ravel().view(np.uint32))


@pytest.mark.parametrize('content', [None, 'empty', 'other'])
def test_what_is_no_recording_is_refused(tmp_path, known, content):
    """A wrong path would end in a traceback, or in an empty picture."""
    path = tmp_path / 'bag'
    if content == 'empty':
        path.mkdir()
    elif content == 'other':
        path.mkdir()
        shutil.copy(known.folder / 'metadata.yaml', path / 'bag_0.mcap')
    with pytest.raises(ClothSimError, match='bag.*give'):
        list(Recording(path).entries('points'))
