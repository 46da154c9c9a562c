# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.


"""Large clouds reach subscribers that have set nothing up for them."""

from pathlib import Path
import re
from xml.etree import ElementTree

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.srv import Step
from cloth_sim_ros.node.large_messages import lost_clouds
from cloth_sim_ros.node.large_messages import use_profile
from cloth_sim_ros.node.large_messages import VARIABLE
from node_process import NodeProcess
import pytest
import quick_discovery
from rclpy.qos import QoSProfile
from rclpy.qos import ReliabilityPolicy
from sensor_msgs.msg import PointCloud2
from shared_memory import largest_segment
from std_srvs.srv import SetBool

MIB = 1 << 20
LARGE = {
    'rows': 512, 'cols': 512, 'dt': 0.01, 'publish.rate': 100.0, 'start_paused': True,
    'publish.markers': False, 'auto_substeps': False,
    **{f'{kind}.{family}': 0.0 for kind in ('stiffness', 'damping')
       for family in ('structural', 'shear', 'bend')}}


def test_a_best_effort_subscriber_gets_every_cloud(client, tmp_path, monkeypatch):
    """RViz, Foxglove or a program with sensor quality would miss most clouds of a large cloth."""
    monkeypatch.delenv(VARIABLE)
    clouds = set()
    with NodeProcess(tmp_path, LARGE, '-r', '__ns:=/large') as node:
        stats = client.watch(ClothStats, '/large/cloth_sim/stats')
        subscription = client.node.create_subscription(
            PointCloud2, '/large/cloth_sim/points',
            lambda cloud: clouds.add(cloud.header.stamp.nanosec // 10_000_000),
            QoSProfile(depth=20, reliability=ReliabilityPolicy.BEST_EFFORT))
        client.spin_until(lambda: stats.messages and 0 in clouds, 'the first cloud')
        for _ in range(12):
            assert client.call(Step, '/large/cloth_sim/step', steps=1).success
        client.spin_until(
            lambda: stats.messages[-1].steps == 12 and 12 in clouds, 'the last cloud')
        assert clouds == set(range(13))
        assert largest_segment(node.pid) > 512 * 512 * 44
        client.node.destroy_subscription(subscription)


@pytest.mark.parametrize('free, name, mebibytes', [
    (256 * MIB, 'fastdds_large_messages.xml', 128),
    (256 * MIB - 1, 'fastdds_large_messages_16_mib.xml', 16),
    (32 * MIB, 'fastdds_large_messages_16_mib.xml', 16)])
def test_takes_the_profile_that_fits(free, name, mebibytes):
    """In a container there would be no shared memory at all: the segment does not fit."""
    environment = {}
    assert use_profile(environment, free) == ''
    file = Path(environment[VARIABLE])
    assert file.name == name
    segment = ElementTree.parse(file).find('.//{*}segment_size')
    assert int(segment.text) == mebibytes * MIB
    assert use_profile(environment, 0) == '', 'once is enough'


def test_the_profiles_differ_in_their_memory_alone():
    """What is mended in one would be left in the other."""
    texts = []
    for free in (256 * MIB, 32 * MIB):
        environment = {}
        use_profile(environment, free)
        root = ElementTree.parse(environment[VARIABLE]).getroot()
        for name in ('segment_size', 'maxMessageSize'):
            root.find(f'.//{{*}}{name}').text = ''
        texts.append(re.sub(r'\s', '', ElementTree.tostring(root, encoding='unicode')))
    assert texts[0] == texts[1]


@pytest.mark.parametrize('environment, lack', [
    ({}, '/dev/shm has 31 MiB free and 32 are needed'),
    ({'RMW_IMPLEMENTATION': 'rmw_cyclonedds_cpp'}, 'rmw_cyclonedds_cpp takes no profile'),
    ({'RMW_IMPLEMENTATION': 'rmw_fastrtps_cpp', VARIABLE: ''}, f'{VARIABLE} is empty'),
    ({VARIABLE: str(quick_discovery.PROFILE)}, 'which has no segment_size'),
    ({VARIABLE: '/nowhere.xml'}, 'which has no segment_size'),
    ({'FASTDDS_BUILTIN_TRANSPORTS': 'UDPv4'}, 'FASTDDS_BUILTIN_TRANSPORTS is UDPv4'),
    ({'FASTDDS_BUILTIN_TRANSPORTS': 'LARGE_DATA'}, '')], ids=str)
def test_what_the_user_has_chosen_stays(environment, lack):
    """A user's own profile would be replaced, or clouds be lost without a word."""
    given = dict(environment)
    told = use_profile(environment, 32 * MIB - 1)
    assert environment == given
    assert lack in told and bool(lack) == bool(told)


@pytest.mark.parametrize('side, lack, told', [
    (109, 'too little', False), (110, 'too little', True), (1000, '', False)])
def test_only_large_clouds_are_spoken_of(side, lack, told):
    """A small cloth would be started with a warning, or a large one without."""
    text = lost_clouds(side * side, lack)
    assert bool(text) == told
    assert not told or '0.53 MB' in text and 'subscribe reliably' in text and lack in text


@pytest.mark.parametrize('points', [True, False])
def test_the_node_warns(points, client, tmp_path):
    """A user whose own profile is too small would look for the missing clouds elsewhere."""
    scene = {**LARGE, 'rows': 128, 'cols': 128, 'publish.points': points}
    with NodeProcess(tmp_path, scene, '-r', f'__ns:=/warns_{points}') as node:
        # It serves only after it has said what there is to say.
        client.call(SetBool, f'/warns_{points}/cloth_sim/pause', data=True)
    told = 'a cloud has 0.72 MB and Fast DDS 0.52 MB of shared memory' in node.output
    assert told == points, node.output
