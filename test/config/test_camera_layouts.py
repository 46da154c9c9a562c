# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The layouts that show what a camera sees, in RViz and Foxglove."""

import json
from pathlib import Path

from cloth_sim_ros.messages.topics import camera_topics
from cloth_sim_ros.sim.model.given_values import load_parameters
import pytest
import yaml

CONFIG = Path(__file__).resolve().parents[2] / 'config'
TOPICS = {topic.full_name('cloth_sim'): topic for topic in camera_topics(['front']).values()}


def test_the_camera_is_that_of_the_scene():
    """The layouts would show nothing with the scene that the pages start."""
    assert load_parameters(CONFIG / 'towel_under_camera.yaml')['cameras.names'] == ['front']


@pytest.mark.parametrize('kind, parts', [
    ('Image', ['image', 'depth']), ('PointCloud2', ['points'])])
def test_rviz_shows_topics_of_the_camera(kind, parts):
    """Nothing would be shown: no such topic, or a quality of service that does not match."""
    manager = yaml.safe_load((CONFIG / 'camera.rviz').read_text())['Visualization Manager']
    shown = [
        each for each in manager['Displays'] if each['Class'] == f'rviz_default_plugins/{kind}']
    assert [each['Topic']['Value'].rpartition('/')[2] for each in shown] == parts
    for each in shown:
        topic = TOPICS[each['Topic']['Value']]
        assert topic.type_name == f'sensor_msgs/msg/{kind}' and each['Enabled']
        assert each['Topic']['Depth'] == topic.depth and topic.reliable
        assert each['Topic']['Reliability Policy'] == 'Reliable'
    assert manager['Global Options']['Fixed Frame'] == 'world'


def test_foxglove_shows_topics_of_the_camera():
    """A panel would stay empty, or not be seen."""
    layout = json.loads((CONFIG / 'foxglove_camera_layout.json').read_text())
    panels = layout['configById']
    images = [each['imageMode'] for name, each in panels.items() if name.startswith('Image!')]
    assert [TOPICS[each['imageTopic']].key.rpartition('/')[2] for each in images] == [
        'image', 'depth', 'labels']
    assert all(
        TOPICS[each['calibrationTopic']].type_name == 'sensor_msgs/msg/CameraInfo'
        for each in images)
    assert set(panels['3D!points']['topics']) <= set(TOPICS)

    def placed(part):
        if isinstance(part, str):
            return [part]
        return placed(part['first']) + placed(part['second'])

    assert sorted(placed(layout['layout'])) == sorted(panels)
