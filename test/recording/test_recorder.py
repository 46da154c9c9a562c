# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A recording under way, and the topics of this project as they stand in it."""

from pathlib import Path
import resource

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Push
from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.inputs import input_message
from cloth_sim_ros.messages.topics import Topic
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_sim_ros.recording.bag_metadata import yaml_text
from cloth_sim_ros.recording.message_definition import message_definition
from cloth_sim_ros.recording.message_definition import type_hash
from cloth_sim_ros.recording.recorder import offered_qos
from cloth_sim_ros.recording.recorder import Recorder
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.inputs import PushNodes
from cloth_sim_ros.sim.model.push import Push as SimPush
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from made_cloud import make_cloud
from mcap.reader import make_reader
from mcap_ros2.reader import read_ros2_messages
import numpy as np
import pytest
import rclpy
from rclpy.context import Context
from rclpy.qos import DurabilityPolicy
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from rclpy.serialization import serialize_message
from rosbags.highlevel import AnyReader
from sensor_msgs.msg import PointCloud2
from springs import SPRINGS
from visualization_msgs.msg import Marker
from visualization_msgs.msg import MarkerArray
import yaml

# As rosbag2 of Jazzy dumps it.
LATCHED = """\
- history: keep_last
  depth: 1
  reliability: reliable
  durability: transient_local
  deadline:
    sec: 9223372036
    nsec: 854775807
  lifespan:
    sec: 9223372036
    nsec: 854775807
  liveliness: automatic
  liveliness_lease_duration:
    sec: 9223372036
    nsec: 854775807
  avoid_ros_namespace_conventions: false"""


def test_text_is_that_of_rosbag2():
    """Players would fall back to another quality of service, and late readers get nothing."""
    assert yaml_text(offered_qos(TOPICS['topology'])) == LATCHED


def test_best_effort_and_volatile_have_their_names():
    """Players would refuse the bag because of an unknown policy."""
    profile, = offered_qos(Topic('points', PointCloud2, depth=5, reliable=False))
    assert (profile['reliability'], profile['durability'], profile['depth']) == (
        'best_effort', 'volatile', 5)


@pytest.mark.parametrize('latched', [True, False])
def test_profile_is_what_a_publisher_offers(latched):
    """A played recording would not reach the readers of the simulation."""
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node('offers', context=context)
    publisher = node.create_publisher(PointCloud2, 'points', QoSProfile(
        depth=1, reliability=ReliabilityPolicy.RELIABLE,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE))
    info, = node.get_publishers_info_by_topic(publisher.topic_name)
    offered = info.qos_profile
    profile, = offered_qos(Topic('points', PointCloud2, depth=1, transient_local=latched))
    assert profile['reliability'] == offered.reliability.short_key
    assert profile['durability'] == offered.durability.short_key
    assert profile['liveliness'] == offered.liveliness.short_key
    for name in ('deadline', 'lifespan', 'liveliness_lease_duration'):
        limit = profile[name]
        assert limit['sec'] * 10**9 + limit['nsec'] == getattr(offered, name).nanoseconds
    node.destroy_node()
    rclpy.shutdown(context=context)


# A recording, read back.

PUSH = SimPush.checked(force=(1.0, 2.0, 3.0), start=0.25, duration=0.5)
FRAMES = 7


@pytest.fixture
def bag(tmp_path):
    """Return the folder of a recording of clouds, numbers, a push and the rest shape."""
    recorder = Recorder(tmp_path, 'run', node_name='/left/cloth_sim')
    recorder.write('topology', serialise_topology(Scene({**SPRINGS, 'rows': 3, 'cols': 4})), 0.0)
    key, push = input_message(PushNodes(PUSH), 0.04, 'world')
    recorder.write(key, serialize_message(push), 0.04)
    for number in range(FRAMES):
        time = number / 50
        recorder.write('points', make_cloud(3, 4, number)[0], time)
        recorder.write('stats', serialize_message(ClothStats(steps=number, sim_time=time)), time)
    recorder.close()
    return recorder.path


def test_rosbags_reads_it_without_our_packages(bag):
    """Recordings could only be read where the simulator is installed."""
    with AnyReader([bag]) as reader:
        entries = [
            (connection.topic, time, reader.deserialize(data, connection.msgtype))
            for connection, time, data in reader.messages()]
        topics = {
            connection.topic: (connection.msgtype, connection.msgcount)
            for connection in reader.connections}
        assert reader.message_count == 2 * FRAMES + 2
        assert (reader.start_time, reader.duration) == (0, 120_000_001)
    assert topics == {
        '/left/cloth_sim/topology': ('shape_msgs/msg/Mesh', 1),
        '/left/cloth_sim/inputs/push': ('cloth_sim_interfaces/msg/Push', 1),
        '/left/cloth_sim/points': ('sensor_msgs/msg/PointCloud2', FRAMES),
        '/left/cloth_sim/stats': ('cloth_sim_interfaces/msg/ClothStats', FRAMES)}
    clouds = [entry for entry in entries if entry[0].endswith('points')]
    for number, (_, time, cloud) in enumerate(clouds):
        points = cloud.data.view(POINT_DTYPE).reshape(cloud.height, cloud.width)
        np.testing.assert_array_equal(points, make_cloud(3, 4, number)[1])
        assert time == number * 20_000_000
        assert cloud.header.stamp.sec * 10**9 + cloud.header.stamp.nanosec == time
    stats = [entry[2] for entry in entries if entry[0].endswith('stats')]
    assert [entry.steps for entry in stats] == list(range(FRAMES))
    push, = [entry[2] for entry in entries if entry[0].endswith('push')]
    assert (push.force.x, push.force.y, push.force.z, push.region) == (1.0, 2.0, 3.0, 'all')
    mesh, = [entry[2] for entry in entries if entry[0].endswith('topology')]
    assert (len(mesh.vertices), len(mesh.triangles)) == (12, 12)


def test_mcap_reads_it(bag):
    """Recordings could not be read by the tools of mcap and Foxglove."""
    entries = list(read_ros2_messages(str(bag / 'run_0.mcap')))
    assert len(entries) == 2 * FRAMES + 2
    clouds = [entry for entry in entries if entry.channel.topic == '/left/cloth_sim/points']
    for number, entry in enumerate(clouds):
        points = np.frombuffer(entry.ros_msg.data, POINT_DTYPE).reshape(3, 4)
        np.testing.assert_array_equal(points, make_cloud(3, 4, number)[1])
        assert entry.log_time_ns == entry.publish_time_ns == number * 20_000_000
    push, = [entry.ros_msg for entry in entries if entry.schema.name.endswith('Push')]
    assert push.duration == PUSH.duration and push.header.frame_id == 'world'


def test_file_is_written_as_rosbag2_does(bag):
    """ros2 bag play would not know types, quality of service or times of the recording."""
    with open(bag / 'run_0.mcap', 'rb') as stream:
        reader = make_reader(stream)
        assert reader.get_header().profile == 'ros2'
        summary = reader.get_summary()
        records = list(reader.iter_metadata())
    assert {index.compression for index in summary.chunk_indexes} == {'zstd'}
    schemas = {schema.name: schema for schema in summary.schemas.values()}
    for channel in summary.channels.values():
        topic = TOPICS[channel.topic.removeprefix('/left/cloth_sim/')]
        schema = summary.schemas[channel.schema_id]
        assert channel.message_encoding == 'cdr'
        assert yaml.safe_load(channel.metadata['offered_qos_profiles']) == offered_qos(topic)
        assert channel.metadata['topic_type_hash'] == type_hash(topic.type_name)
        assert (schema.name, schema.encoding) == (topic.type_name, 'ros2msg')
        assert schema.data.decode() == message_definition(topic.type_name)
    assert len(summary.channels) == len(schemas) == 4
    beside = yaml.safe_load((bag / 'metadata.yaml').read_text())['rosbag2_bagfile_information']
    assert {record.name for record in records} == {'rosbag2'}
    assert yaml.safe_load(records[-1].metadata['serialized_metadata']) == beside
    assert beside['relative_file_paths'] == ['run_0.mcap']
    assert sorted(path.name for path in bag.iterdir()) == ['metadata.yaml', 'run_0.mcap']


def test_an_empty_recording_is_a_bag(tmp_path):
    """A recording that was stopped at once could not be opened."""
    recorder = Recorder(tmp_path)
    recorder.close()
    with AnyReader([recorder.path]) as reader:
        assert reader.message_count == 0


def test_what_is_not_recorded_is_left_out(tmp_path):
    """Markers would fill the disk with what the points say already."""
    recorder = Recorder(tmp_path)
    recorder.write('markers', b'', 0.0)
    recorder.close()
    with AnyReader([recorder.path]) as reader:
        assert reader.message_count == 0


def test_markers_are_recorded_where_they_are_asked_for(tmp_path):
    """Foxglove and RViz would show the nodes of a recording, without a surface or a collider."""
    recorder = Recorder(tmp_path, options=RecordingOptions(markers=True))
    assert recorder.takes('markers')
    data = serialize_message(MarkerArray(markers=[Marker(ns='collider/ball')]))
    recorder.write('markers', data, 0.5)
    recorder.close()
    with AnyReader([recorder.path]) as reader:
        (connection, time, recorded), = reader.messages()
        marker, = reader.deserialize(recorded, connection.msgtype).markers
    assert connection.topic == '/cloth_sim/markers'
    assert (marker.ns, time) == ('collider/ball', 500_000_000)


def test_closing_again_and_writing_late_change_nothing(tmp_path):
    """A node that stops twice, or sends while it stops, would damage the recording."""
    recorder = Recorder(tmp_path)
    data = serialize_message(ClothStats(steps=1))
    recorder.write('stats', data, 0.0)
    recorder.close()
    content = (recorder.path / 'metadata.yaml').read_bytes()
    recorder.close()
    recorder.write('stats', data, 1.0)
    recorder.close()
    assert (recorder.path / 'metadata.yaml').read_bytes() == content
    with AnyReader([recorder.path]) as reader:
        assert reader.message_count == 1


def test_it_closes_after_ros_has_shut_down(tmp_path):
    """A node that is interrupted would lose its recording."""
    context = rclpy.context.Context()
    rclpy.init(context=context)
    recorder = Recorder(tmp_path)
    recorder.write('stats', serialize_message(ClothStats()), 0.0)
    rclpy.shutdown(context=context)
    recorder.close()
    with AnyReader([recorder.path]) as reader:
        assert reader.message_count == 1


def test_messages_larger_than_a_chunk(tmp_path):
    """The clouds of a large cloth would be cut or lost."""
    recorder = Recorder(tmp_path)
    for number in range(4):
        recorder.write('points', make_cloud(512, 512, number)[0], number / 50)
    recorder.close()
    with AnyReader([recorder.path]) as reader:
        for number, (connection, _, data) in enumerate(reader.messages()):
            cloud = reader.deserialize(data, connection.msgtype)
            points = cloud.data.view(POINT_DTYPE).reshape(512, 512)
            np.testing.assert_array_equal(points, make_cloud(512, 512, number)[1])
    assert number == 3


def test_two_recordings_at_once_do_not_mix(tmp_path):
    """Two nodes that record into one directory would write into each other's file."""
    recorders = [Recorder(tmp_path, node_name=name) for name in ('a', 'b')]
    for recorder in recorders:
        recorder.write('inputs/push', serialize_message(Push()), 0.0)
    for recorder, name in zip(recorders, 'ab'):
        recorder.close()
        with AnyReader([recorder.path]) as reader:
            assert [connection.topic for connection in reader.connections] == [
                f'/{name}/inputs/push']


@pytest.mark.parametrize(('directory', 'name'), [('.', '../x'), ('.', 'taken'), ('file', 'x')])
def test_what_cannot_be_opened_leaves_nothing_behind(tmp_path, directory, name):
    """A refused recording would leave an empty folder, or a thread that keeps the node alive."""
    (tmp_path / 'taken').mkdir()
    (tmp_path / 'file').write_text('data')
    with pytest.raises(ClothSimError):
        Recorder(tmp_path / directory, name)
    assert sorted(Path(tmp_path).rglob('*')) == [tmp_path / 'file', tmp_path / 'taken']


def test_a_disk_that_is_full_from_the_start_is_told(tmp_path):
    """An empty folder would be left behind by each attempt."""
    _, most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8, most))
    try:
        with pytest.raises(ClothSimError, match='File too large'):
            Recorder(tmp_path / 'bags', 'run')
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
    assert list((tmp_path / 'bags').iterdir()) == []


def test_an_unknown_topic_is_a_fault_of_the_caller(tmp_path):
    """A misspelt topic would be missing from all recordings, unnoticed."""
    recorder = Recorder(tmp_path)
    with pytest.raises(KeyError):
        recorder.write('no_such_topic', b'', 0.0)
    recorder.close()
