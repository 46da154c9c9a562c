# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The policy for secured graphs allows what the node has, and nothing else."""

from pathlib import Path
from xml.etree import ElementTree

from cloth_sim_ros.messages.topics import CAMERA_PARTS
from cloth_sim_ros.messages.topics import TOPICS
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from rclpy.node import NodeNameNonExistentError
from std_srvs.srv import SetBool

FILE = Path(__file__).resolve().parents[2] / 'config' / 'sros2_policy.xml'
RULES = {
    ('topics', 'publish'), ('topics', 'subscribe'), ('services', 'reply'), ('services', 'request')}
# Colliders, grasps and cameras have topics of their own, which the policy has by a pattern.
SCENE = {
    'publish.clock': True, 'colliders.names': ['ball'], 'colliders.ball.size': [0.1],
    'grasps.start': [9.0], 'grasps.name': ['hand'], 'grasps.position': [0.0, 0.0, 1.0],
    'cameras.names': ['eye'], 'cameras.eye.position': [1.0, 0.0, 1.0],
    'cameras.eye.target': [0.0, 0.0, 0.0]}
PATTERNS = {
    '/cloth_sim/colliders/*/pose': '/cloth_sim/colliders/ball/pose',
    '/cloth_sim/grasps/*/target': '/cloth_sim/grasps/hand/target',
    **{f'/cloth_sim/cameras/*/{part}': f'/cloth_sim/cameras/eye/{part}' for part in CAMERA_PARTS}}
# ROS opens these two for every node, and they change nothing.
# What sros2 makes of an action: services of its server, and topics that this publishes.
ACTION = {
    ('services', 'send_goal'), ('services', 'cancel_goal'), ('services', 'get_result'),
    ('topics', 'feedback'), ('topics', 'status')}
OF_ACTIONS = {
    ('execute', 'services'): 'reply', ('execute', 'topics'): 'publish',
    ('call', 'services'): 'request', ('call', 'topics'): 'subscribe'}
OF_EVERY_NODE = {'/parameter_events', '/rosout'}


def rights(enclave: str) -> dict[tuple[str, str], set[str]]:
    """Return the names that each kind of rule of an enclave allows."""
    profile = ElementTree.parse(FILE).find(f".//enclave[@path='{enclave}']/profiles/profile")
    own = f"{profile.get('ns')}{profile.get('node')}"
    found = {rule: set() for rule in RULES}
    for group in profile:
        (kind, answer), = group.attrib.items()
        assert answer == 'ALLOW'
        names = [entry.text.replace('~', own, 1) for entry in group]
        assert len(set(names)) == len(names)
        if group.tag == 'actions':
            for part, name in ACTION:
                found[part, OF_ACTIONS[kind, part]] |= {
                    f'{action}/_action/{name}' for action in names}
            continue
        found[group.tag, kind] |= {PATTERNS.get(name, name) for name in names}
    return found


@pytest.fixture(scope='module')
def endpoints(tmp_path_factory):
    """Return what a running node has, in the order of the policy's rules."""
    folder = tmp_path_factory.mktemp('policy')
    with GraphClient() as client, NodeProcess(folder, SCENE):
        client.call_until_answered(SetBool, '/cloth_sim/pause', data=True)
        graph = client.node

        def names(ask):
            # It answers before all others know of it.
            try:
                return {name for name, _ in ask('cloth_sim', '/')}
            except NodeNameNonExistentError:
                return set()

        # Another of the same name may just have ended, without a hand.
        client.spin_until(
            lambda: PATTERNS['/cloth_sim/grasps/*/target'] in names(
                graph.get_subscriber_names_and_types_by_node), 'the grasp')
        # The clock waits until nobody else can have it.
        client.spin_until(
            lambda: '/clock' in names(graph.get_publisher_names_and_types_by_node), '/clock')
        assert not names(graph.get_client_names_and_types_by_node)
        return {
            ('topics', 'publish'): names(graph.get_publisher_names_and_types_by_node),
            ('topics', 'subscribe'): names(graph.get_subscriber_names_and_types_by_node),
            ('services', 'reply'): names(graph.get_service_names_and_types_by_node),
            ('services', 'request'): set()}


def test_it_has_the_form_of_a_policy():
    """The tools of SROS2 would refuse it."""
    root = ElementTree.parse(FILE).getroot()
    assert (root.tag, root.get('version')) == ('policy', '0.2.0')
    assert [enclave.get('path') for enclave in root.find('enclaves')] == [
        '/cloth_sim', '/cloth_sim/viewer', '/cloth_sim/operator']
    entries = {'topics': 'topic', 'services': 'service', 'actions': 'action'}
    for group in root.iterfind('.//profile/*'):
        assert {entry.tag for entry in group} == {entries[group.tag]}


def test_the_node_may_do_what_it_does_and_no_more(endpoints):
    """A secured node would not start, or a stolen key of it could do more than the node."""
    allowed = rights('/cloth_sim')
    # With use_sim_time it reads /clock, and else not.
    allowed['topics', 'subscribe'] -= {'/clock'}
    assert allowed == endpoints


def test_a_viewer_reads_and_changes_nothing(endpoints):
    """A viewer could push the cloth, or would not see all of it."""
    allowed = rights('/cloth_sim/viewer')
    of_actions = {name for name in endpoints['topics', 'publish'] if '/_action/' in name}
    assert allowed['topics', 'subscribe'] == (
        endpoints['topics', 'publish'] - OF_EVERY_NODE - of_actions)
    assert allowed['topics', 'subscribe'] >= {
        f'/cloth_sim/{key}' for key, topic in TOPICS.items() if not topic.is_global}
    assert allowed['topics', 'publish'] == OF_EVERY_NODE
    assert not allowed['services', 'request'] | allowed['services', 'reply']


def test_an_operator_acts_by_services_and_targets(endpoints):
    """A verb would be refused, or who operates the cloth could set its parameters."""
    allowed = rights('/cloth_sim/operator')
    of_parameters = {
        name for name in endpoints['services', 'reply']
        if 'parameter' in name or name.endswith('get_type_description')}
    # It may read them: `cloth_sim wind` asks whether there is air.
    reading = {'/cloth_sim/get_parameters'}
    assert reading < of_parameters
    assert allowed['services', 'request'] == (
        endpoints['services', 'reply'] - of_parameters | reading)
    assert allowed['topics', 'publish'] - OF_EVERY_NODE == (
        endpoints['topics', 'subscribe'] - {'/clicked_point', '/tf', '/tf_static'})
    of_actions = {name for name in endpoints['topics', 'publish'] if '/_action/' in name}
    assert allowed['topics', 'subscribe'] == of_actions | {
        '/cloth_sim/inputs/wind', '/cloth_sim/state', '/cloth_sim/stats'}
    assert not allowed['services', 'reply']
