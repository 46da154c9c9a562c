# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The layout that ships for Foxglove."""

import json
from pathlib import Path
import re
import subprocess

from cloth_sim_interfaces.msg import ClothStats
from cloth_sim_interfaces.msg import Push
from cloth_sim_interfaces.srv import SetMode
from cloth_sim_interfaces.srv import SetPin
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import pytest
from std_srvs.srv import Trigger

ROOT = Path(__file__).resolve().parents[2]
FILE = ROOT / 'config' / 'foxglove_layout.json'
SERVICES = {'set_pin': SetPin, 'set_mode': SetMode, 'reset': Trigger}
PUBLISHED = {topic.full_name('cloth_sim') for topic in TOPICS.values()}


@pytest.fixture(scope='module')
def layout():
    """Return the whole layout."""
    return json.loads(FILE.read_text(encoding='utf-8'))


def panels(layout, kind):
    """Return the settings of the panels of this kind."""
    return [
        settings for name, settings in layout['configById'].items()
        if name.startswith(f'{kind}!')]


def placed(part):
    """Return the names of the panels in a part of the arrangement."""
    if isinstance(part, str):
        return [part]
    return placed(part['first']) + placed(part['second'])


def test_every_panel_has_a_place(layout):
    """A panel would not be seen, or be empty."""
    assert sorted(placed(layout['layout'])) == sorted(layout['configById'])


def test_shows_topics_of_the_node(layout):
    """The view would stay empty."""
    view, = panels(layout, '3D')
    assert {'/cloth_sim/points', '/cloth_sim/markers'} <= set(view['topics']) <= PUBLISHED
    assert view['topics']['/cloth_sim/points']['colorField'] in POINT_DTYPE.names
    assert view['publish']['pointTopic'] == '/clicked_point'


def test_the_cloth_is_not_behind_the_names_of_frames(layout):
    """Names of 20 cm, and a line from the origin to each pin, would cover the cloth."""
    view, = panels(layout, '3D')
    transforms = view['scene']['transforms']
    assert transforms['showLabel'] is False
    assert transforms['lineWidth'] == 0
    assert transforms['axisScale'] <= 0.25


def test_frames_are_there_wherever_a_recording_is_entered(layout):
    """Of /tf only the last message would count there: that of the colliders, not of the pins."""
    view, = panels(layout, '3D')
    assert view['scene']['transforms']['enablePreloading'] is True


def test_plots_numbers_that_are_published(layout):
    """A plot would stay empty."""
    paths = [path['value'] for plot in panels(layout, 'Plot') for path in plot['paths']]
    fields = ClothStats.get_fields_and_field_types()
    assert len(paths) >= 6
    for path in paths:
        topic, _, field = path.partition('.')
        assert topic == '/cloth_sim/stats'
        assert field in fields


def test_the_push_is_a_push(layout):
    """The button would send a message that the node does not know."""
    panel, = panels(layout, 'Publish')
    assert panel['topicName'] == '/cloth_sim/push'
    assert panel['datatype'] == 'cloth_sim_interfaces/msg/Push'
    assert set(json.loads(panel['value'])) <= set(Push.get_fields_and_field_types())


def test_the_calls_are_services_of_the_node(layout):
    """A button would call a service that is not there, or in a way it does not take."""
    calls = panels(layout, 'CallService')
    assert len(calls) == len(SERVICES)
    for panel in calls:
        node, name = panel['serviceName'].rsplit('/', 1)
        assert node == '/cloth_sim'
        request = SERVICES[name].Request.get_fields_and_field_types()
        assert set(json.loads(panel['requestPayload'])) <= set(request)


def names_in(part):
    """Return every name of a topic or a service in a part of the layout."""
    if isinstance(part, dict):
        return [name for key, value in part.items() for name in names_in(key) + names_in(value)]
    if isinstance(part, list):
        return [name for value in part for name in names_in(value)]
    return [part] if isinstance(part, str) and part.startswith('/') else []


def test_the_command_of_the_docs_moves_it_into_a_namespace(layout):
    """Foxglove would show another node than the one in the namespace, or push it."""
    command = re.search(
        r'^ {4}(sed .* config/foxglove_layout.json) > left_layout.json$',
        (ROOT / 'docs' / 'how_to' / 'viewers.md').read_text(encoding='utf-8'), re.MULTILINE)[1]
    moved = subprocess.run(
        command, shell=True, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    names = names_in(layout)
    assert '/clicked_point' in names
    assert names_in(json.loads(moved)) == [f'/left{name}' for name in names]
