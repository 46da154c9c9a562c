# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The display that ships for RViz."""

import ast
from pathlib import Path

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / 'config' / 'cloth_sim.rviz'
LAUNCH_FILE = ROOT / 'launch' / 'cloth_sim.launch.py'


@pytest.fixture(scope='module')
def manager():
    """Return the part that says what is shown."""
    return yaml.safe_load(FILE.read_text(encoding='utf-8'))['Visualization Manager']


def display(manager, kind):
    """Return the display of this kind."""
    found, = (
        shown for shown in manager['Displays']
        if shown['Class'] == f'rviz_default_plugins/{kind}')
    return found


@pytest.mark.parametrize('kind, type_name, key', [
    ('PointCloud2', 'PointCloud2', 'points'), ('MarkerArray', 'MarkerArray', 'markers'),
    ('Wrench', 'WrenchStamped', 'pins/wrenches')])
def test_shows_topics_of_the_node(manager, kind, type_name, key):
    """Nothing would be shown: no such topic, or a quality of service that does not match."""
    topic, shown = TOPICS[key], display(manager, kind)
    assert topic.type_name.endswith(f'/{type_name}')
    assert shown['Topic']['Value'] == topic.full_name('cloth_sim')
    assert shown['Topic']['Reliability Policy'] == 'Reliable'
    assert topic.reliable
    assert shown['Topic']['Depth'] == topic.depth
    assert shown['Enabled']


def test_colors_are_those_of_strain(manager):
    """The nodes would be coloured by a field that is not there."""
    assert display(manager, 'PointCloud2')['Channel Name'] in POINT_DTYPE.names


def test_the_fixed_frame_is_that_of_the_node(manager):
    """The display would ask for a transform that nobody publishes."""
    frame, = (field.default for field in NODE_FIELDS if field.name == 'frame_id')
    assert manager['Global Options']['Fixed Frame'] == frame


def test_a_click_reaches_the_node(manager):
    """Clicking on the cloth would do nothing."""
    tool, = (
        tool for tool in manager['Tools'] if tool['Class'].endswith('/PublishPoint'))
    assert tool['Topic']['Value'] == '/clicked_point'


def constant(name):
    """Return a constant of the launch file."""
    tree = ast.parse(LAUNCH_FILE.read_text(encoding='utf-8'))
    value, = (
        node.value for node in tree.body
        if isinstance(node, ast.Assign) and node.targets[0].id == name)
    return ast.literal_eval(value)


def test_every_topic_follows_the_namespace(manager):
    """Launched in a namespace, RViz would show nothing, or the cloth of another node."""
    shown = {entry['Topic']['Value'] for entry in manager['Displays'] if 'Topic' in entry}
    assert set(constant('RVIZ_TOPICS')) == shown
    published = {
        tool['Topic']['Value'] for tool in manager['Tools'] if 'Topic' in tool}
    assert {constant('CLICKS')[0]} == published
