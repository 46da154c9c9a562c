# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Names, types and quality of service of the topics."""

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.outlet import Outlet
from cloth_sim_ros.node.recording_session import RecordingSession
from cloth_sim_ros.recording.bag_folder import RecordingOptions
from cloth_under_test import NAMESPACE
import pytest
import rclpy
from rclpy.qos import DurabilityPolicy
from rclpy.qos import ReliabilityPolicy
from rosbags.highlevel import AnyReader
from shape_msgs.msg import Mesh

NAMES_AND_TYPES = {
    '~/points': 'sensor_msgs/msg/PointCloud2',
    '~/markers': 'visualization_msgs/msg/MarkerArray',
    '~/topology': 'shape_msgs/msg/Mesh',
    '~/stats': 'cloth_sim_interfaces/msg/ClothStats',
    '~/pins/wrenches': 'geometry_msgs/msg/WrenchStamped',
    '~/pins/peak_wrenches': 'geometry_msgs/msg/WrenchStamped',
    '~/grasps/wrenches': 'geometry_msgs/msg/WrenchStamped',
    '~/grasps/peak_wrenches': 'geometry_msgs/msg/WrenchStamped',
    '~/colliders/wrenches': 'geometry_msgs/msg/WrenchStamped',
    '~/state': 'cloth_sim_interfaces/msg/ClothState',
    '/tf': 'tf2_msgs/msg/TFMessage',
    '/diagnostics': 'diagnostic_msgs/msg/DiagnosticArray',
    '~/inputs/push': 'cloth_sim_interfaces/msg/Push',
    '~/inputs/pin': 'cloth_sim_interfaces/msg/PinChange',
    '~/inputs/pin_target': 'cloth_sim_interfaces/msg/PinTarget',
    '~/inputs/grasp': 'cloth_sim_interfaces/msg/GraspChange',
    '~/inputs/grasp_target': 'cloth_sim_interfaces/msg/FrameTarget',
    '~/inputs/collider_target': 'cloth_sim_interfaces/msg/FrameTarget',
    '~/inputs/wind': 'geometry_msgs/msg/Vector3Stamped',
    '~/inputs/mode': 'cloth_sim_interfaces/msg/ModeChange',
    '~/inputs/command': 'cloth_sim_interfaces/msg/Command',
    '~/inputs/parameters': 'rcl_interfaces/msg/ParameterEvent',
    '~/inputs/time_base': 'cloth_sim_interfaces/msg/TimeBase',
}
SERVICES = {
    'set_mode': 'cloth_sim_interfaces/srv/SetMode',
    'apply_push': 'cloth_sim_interfaces/srv/ApplyPush',
    'clear_pushes': 'std_srvs/srv/Trigger',
    'set_pin': 'cloth_sim_interfaces/srv/SetPin',
    'move_pin': 'cloth_sim_interfaces/srv/MovePin',
    'grasp': 'cloth_sim_interfaces/srv/Grasp',
    'release': 'cloth_sim_interfaces/srv/Release',
    'move_grasp': 'cloth_sim_interfaces/srv/MoveFrame',
    'move_collider': 'cloth_sim_interfaces/srv/MoveFrame',
    'follow_grasp': 'cloth_sim_interfaces/srv/FollowFrame',
    'follow_collider': 'cloth_sim_interfaces/srv/FollowFrame',
    'reset': 'std_srvs/srv/Trigger',
    'pause': 'std_srvs/srv/SetBool',
    'step': 'cloth_sim_interfaces/srv/Step',
    'start_recording': 'cloth_sim_interfaces/srv/StartRecording',
    'stop_recording': 'std_srvs/srv/Trigger',
}
KEPT = {'topology', 'state', 'time_base'}


@pytest.mark.parametrize('name', NAMES_AND_TYPES)
def test_topic_has_its_type_and_quality(cloth, name):
    """A subscriber with the documented settings would get nothing."""
    publisher = next(
        info for info in cloth.client.node.get_publishers_info_by_topic(
            name.replace('~', cloth.name))
        if f'{info.node_namespace}/{info.node_name}' == cloth.name)
    assert publisher.topic_type == NAMES_AND_TYPES[name]
    quality = publisher.qos_profile
    assert quality.reliability == ReliabilityPolicy.RELIABLE
    kept = name.rpartition('/')[2] in KEPT
    assert (quality.durability == DurabilityPolicy.TRANSIENT_LOCAL) == kept


def test_every_topic_of_the_table_is_there(cloth):
    """A topic would be added to the table, and never published."""
    names = {topic.name for key, topic in TOPICS.items() if key != 'clock'}
    assert names == set(NAMES_AND_TYPES)


def test_services_have_their_types(cloth):
    """A client made from the documentation would find no service."""
    offered = dict(cloth.client.node.get_service_names_and_types_by_node(
        'cloth_sim', NAMESPACE))
    for name, kind in SERVICES.items():
        assert offered[f'{cloth.name}/{name}'] == [kind]


def test_listens_to_pushes_targets_clicks_and_wind(cloth):
    """A push from RViz or Foxglove, a controller's target, or a wind, would go nowhere."""
    listened = dict(cloth.client.node.get_subscriber_names_and_types_by_node(
        'cloth_sim', NAMESPACE))
    assert listened[f'{cloth.name}/push'] == ['cloth_sim_interfaces/msg/Push']
    assert listened[f'{cloth.name}/pins/target'] == ['cloth_sim_interfaces/msg/PinTarget']
    assert listened[f'{cloth.name}/wind'] == ['geometry_msgs/msg/Vector3Stamped']
    assert listened['/clicked_point'] == ['geometry_msgs/msg/PointStamped']
    assert listened['/tf'] == listened['/tf_static'] == ['tf2_msgs/msg/TFMessage']


def test_who_listens_to_itself_is_no_reader(client, tmp_path):
    """The node would make transforms of all its pins in every frame, with nobody to read them."""
    node = rclpy.create_node('echo', context=client.node.context)
    outlet = Outlet(node, RecordingSession(str(tmp_path), 'echo', print), heard_here=('stats',))
    publisher, = (each for each in node.publishers if each.topic_name == '/echo/stats')
    node.create_subscription(ClothStats, '~/stats', print, 10)
    client.spin_until(lambda: publisher.get_subscription_count() == 1, 'its own subscription')
    assert not outlet.wanted('stats')
    subscription = client.node.create_subscription(ClothStats, '/echo/stats', print, 10)
    client.spin_until(lambda: outlet.wanted('stats'), 'a reader is known')
    client.node.destroy_subscription(subscription)
    client.spin_until(lambda: not outlet.wanted('stats'), 'the reader has gone')
    node.destroy_node()


def test_a_recording_of_markers_reads_them(client, tmp_path):
    """The node would make no markers for it, as long as no viewer shows them."""
    node = rclpy.create_node('draws', context=client.node.context)
    for name, markers in (('bare', False), ('drawn', True)):
        session = RecordingSession(
            str(tmp_path), 'draws', print, options=RecordingOptions(markers=markers))
        outlet = Outlet(node, session)
        assert not outlet.wanted('markers')
        session.start(name)
        assert outlet.wanted('markers') == markers
        assert outlet.wanted('points') and not outlet.wanted('points', by_recording=False)
        outlet.send('markers', lambda: b'', 0.0, number=session.number)
        # A recording that has ended.
        outlet.send('markers', lambda: b'', 0.0, number=session.number - 1)
        session.stop()
        with AnyReader([tmp_path / name]) as reader:
            assert reader.message_count == int(markers)
    node.destroy_node()


def test_topology_is_kept_for_those_who_come_late(cloth, simulation):
    """A viewer that starts after the node would never learn the faces."""
    mesh = cloth.client.read_kept(Mesh, f'{cloth.name}/topology')
    assert len(mesh.triangles) == 2 * 7 * 9
    rest = simulation.scene.rest_positions().reshape(-1, 3)
    assert [(vertex.x, vertex.y, vertex.z) for vertex in mesh.vertices] == [
        tuple(node) for node in rest.tolist()]
