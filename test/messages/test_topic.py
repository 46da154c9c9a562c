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

"""Names of a topic."""

from cloth_sim_ros.messages.topic import Topic
from sensor_msgs.msg import PointCloud2


def test_name_is_private_unless_global():
    """Two nodes would publish to one topic, or /clock under a node's name."""
    assert Topic('points', PointCloud2, depth=1).name == '~/points'
    assert Topic('clock', PointCloud2, depth=1, is_global=True).name == '/clock'


def test_full_name_holds_namespace():
    """A recording would name topics otherwise than the graph."""
    topic = Topic('inputs/push', PointCloud2, depth=1)
    assert topic.full_name('cloth_sim') == '/cloth_sim/inputs/push'
    assert topic.full_name('/left/cloth_sim') == '/left/cloth_sim/inputs/push'
    assert Topic('clock', PointCloud2, depth=1, is_global=True).full_name('/a/b') == '/clock'


def test_type_name_is_that_of_the_message():
    """A recording would name a type that is not there."""
    assert Topic('points', PointCloud2, depth=1).type_name == 'sensor_msgs/msg/PointCloud2'
