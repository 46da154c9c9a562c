# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""What README.md and the pages of docs say is so."""

from argparse import ArgumentParser
import ast
from functools import partial
from importlib import import_module
from pathlib import Path
import re
import shlex
import subprocess
import sys

from cloth_sim_ros.messages.requests import ACTIONS
from cloth_sim_ros.messages.requests import SERVICES
from cloth_sim_ros.messages.requests import SUBSCRIPTIONS
from cloth_sim_ros.messages.topics import camera_topics
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.missing_module import BUILD_COMMAND
from cloth_sim_ros.verb.main import VERBS
from graph_client import GraphClient
from node_process import NodeProcess
import pytest
from rclpy.action import get_action_server_names_and_types_by_node
from rclpy.node import NodeNameNonExistentError
from std_srvs.srv import SetBool

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / 'docs'
PAGES = [ROOT / 'README.md', ROOT / 'bags' / 'README.md', *sorted(DOCS.rglob('*.md'))]
MOST_LINES = 100
COMMAND = re.compile(r'^ {4}(cloth_sim [^#\n]*)', re.MULTILINE)
PICTURE = re.compile(r'!\[[^]]*\]\(([^)]+)\)')
CONTINUED = re.compile(r'\\\n *')
COMMANDS = sorted({
    command.strip() for page in PAGES
    for command in COMMAND.findall(CONTINUED.sub(' ', page.read_text(encoding='utf-8')))})
# A program and what it prints.
PROGRAM = re.compile(
    r'```python\n((?:(?!```).)*)```\n\nprints\n\n```text\n(.*?)```', re.DOTALL)
PROGRAMS = [
    pytest.param(*found, id=f'{page.relative_to(ROOT)}-{number}')
    for page in PAGES if page != ROOT / 'bags' / 'README.md'
    for number, found in enumerate(PROGRAM.findall(page.read_text(encoding='utf-8')))]
NUMBER = re.compile(r'-?\d+(?:\.\d+)?')
CODE = re.compile(r'```python\n(.*?)```', re.DOTALL)


def reference(name):
    """Return the text of a generated page."""
    return (DOCS / 'reference' / f'{name}.md').read_text(encoding='utf-8')


def rows(text, heading):
    """Return the cells of the first table below a heading, without the header."""
    lines = text.partition(f'{heading}\n')[2].partition('\n#')[0].splitlines()
    table = [line.strip('| ').split(' | ') for line in lines if line.startswith('| `')]
    return [[cell.strip('`') for cell in row] for row in table]


def test_the_readme_is_short():
    """A newcomer would have to search for the first steps."""
    assert len((ROOT / 'README.md').read_text(encoding='utf-8').splitlines()) <= MOST_LINES


def test_reference_pages_are_those_of_the_code():
    """The pages would lack a parameter, topic, service or verb, or have an old default."""
    done = subprocess.run(
        [sys.executable, ROOT / 'scripts' / 'reference_pages.py', '--check'],
        capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_topics_are_those_of_the_code():
    """The page would lack a topic, or give another type."""
    assert {row[0]: row[1] for row in rows(reference('topics'), '## Published')} == {
        topic.name: topic.type_name for topic in TOPICS.values()}
    assert {row[0]: row[1] for row in rows(
        reference('topics'), '## Published of each camera')} == {
            topic.name: topic.type_name for topic in camera_topics(['NAME']).values()}


def test_services_are_those_of_the_code():
    """The page would lack a service, or give another type."""
    assert {row[0]: row[1] for row in rows(
            reference('services'), '# Services and actions')} == {
        service.name: service.type_name for service in SERVICES}


def test_actions_are_those_of_the_code():
    """The page would lack an action, or give another type."""
    assert {row[0]: row[1] for row in rows(reference('services'), '## Actions')} == {
        action.name: action.type_name for action in ACTIONS}


def test_subscriptions_are_those_of_the_code():
    """The page would lack a topic that the node listens to, or give another type."""
    assert {row[0]: row[1] for row in rows(reference('topics'), '## Subscribed')} == {
        topic.name: topic.type_name for topic in SUBSCRIPTIONS}


def test_a_node_has_the_services_and_subscriptions(tmp_path):
    """The pages would have one that no node has, or lack one that each node has."""
    # NAME stands for any collider and grasp on the pages.
    scene = {
        'colliders.names': ['ball'], 'colliders.ball.size': [0.1], 'grasps.start': [9.0],
        'grasps.name': ['hand'], 'grasps.position': [0.0, 0.0, 1.0]}
    one_for_any = {
        '~/colliders/ball/pose': '~/colliders/NAME/pose',
        '~/grasps/hand/target': '~/grasps/NAME/target'}
    with GraphClient() as client, NodeProcess(tmp_path, scene):
        client.call_until_answered(SetBool, '/cloth_sim/pause', data=True)

        def offered(ask):
            # It answers before all others know of it.
            try:
                found = ask('cloth_sim', '/')
            except NodeNameNonExistentError:
                return {}
            own = {name.replace('/cloth_sim/', '~/'): kind for name, (kind,) in found}
            # ROS gives each node services for its parameters and types.
            return {
                one_for_any.get(name, name): kind for name, kind in own.items()
                if 'parameter' not in name and '/_action/' not in name
                and not name.endswith('get_type_description')}

        for kinds, ask in (
                (SERVICES, client.node.get_service_names_and_types_by_node),
                (ACTIONS, partial(get_action_server_names_and_types_by_node, client.node)),
                (SUBSCRIPTIONS, client.node.get_subscriber_names_and_types_by_node)):
            expected = {each.name: each.type_name for each in kinds}
            client.spin_until(lambda: expected.keys() <= offered(ask).keys(), 'all of them')
            assert offered(ask) == expected


def test_every_verb_has_a_section():
    """A user would not learn of a verb."""
    assert re.findall(r'^## cloth_sim (\w+)$', reference('verbs'), re.MULTILINE) == list(VERBS)


def test_launch_arguments_are_those_of_the_launch_file():
    """An argument would be missing, or not work."""
    text = (ROOT / 'launch' / 'cloth_sim.launch.py').read_text(encoding='utf-8')
    declared = re.findall(r"DeclareLaunchArgument\(\s*'(\w+)'", text)
    assert [row[0] for row in rows(reference('launch'), '# Launch file')] == declared


def test_the_workspace_command_is_the_one_the_node_gives():
    """There would be two commands for one thing, and one of them never tried."""
    page = (DOCS / 'tutorial' / 'install.md').read_text(encoding='utf-8')
    assert f'\n    {BUILD_COMMAND}\n' in page


@pytest.mark.parametrize('command', COMMANDS)
def test_commands_can_be_typed_as_they_stand(command):
    """A command of the pages would be refused."""
    _, name, *arguments = shlex.split(command)
    verb = import_module(f'cloth_sim_ros.verb.{name}')
    parser = ArgumentParser()
    verb.add_arguments(parser)
    if '--help' in arguments:
        with pytest.raises(SystemExit, match='^0$'):
            parser.parse_args(arguments)
    else:
        parser.parse_args(arguments)


@pytest.mark.parametrize(('program', 'printed'), PROGRAMS)
def test_programs_print_what_the_page_shows(program, printed):
    """A program of the pages would fail, or print something else."""
    done = subprocess.run(
        [sys.executable, '-c', program], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    for shown, real in zip(NUMBER.findall(printed), NUMBER.findall(done.stdout), strict=True):
        assert float(real) == pytest.approx(float(shown), rel=0.02, abs=0.02)
    assert words(done.stdout) == words(printed)


def words(text):
    """Return the text without its numbers: devices round differently."""
    return NUMBER.sub('', text).split()


def test_programs_import_what_exists():
    """A program that is only shown would begin with an import that fails."""
    for page in PAGES:
        for program in CODE.findall(page.read_text(encoding='utf-8')):
            for node in ast.walk(ast.parse(program)):
                if isinstance(node, ast.ImportFrom):
                    module = import_module(node.module)
                    assert all(hasattr(module, name.name) for name in node.names), node.module


@pytest.mark.parametrize('page', PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_somewhere(page):
    """A reader would follow a link to nothing."""
    for target in re.findall(r'\]\(([^)#]+)\)', page.read_text(encoding='utf-8')):
        assert '://' in target or (page.parent / target).exists(), target


@pytest.mark.parametrize(
    'figure', sorted((ROOT / 'docs' / 'figures').glob('*.png')), ids=lambda path: path.name)
def test_figures_are_shown_small_and_with_their_command(figure):
    """A figure would be in nobody's page, take long to load, or not be made again."""
    name = f'docs/figures/{figure.name}'
    pages = {page: page.read_text(encoding='utf-8') for page in PAGES}
    assert any(
        (page.parent / target).resolve() == figure
        for page, text in pages.items() for target in PICTURE.findall(text))
    options = ('--out', '--sheet', '--figure', '--plot')
    assert any(f'{option} {name}' in text for text in pages.values() for option in options)
    assert figure.stat().st_size < 500_000


@pytest.mark.parametrize(
    'scene', sorted([*(ROOT / 'config').glob('*.yaml'), *(ROOT / 'config' / 'paper').glob('*')]),
    ids=lambda p: p.name)
def test_every_scene_has_an_entry(scene):
    """A user would not learn of a scene."""
    assert [row for row in rows(reference('scenes'), '# Scenes')
            if row[0] == str(scene.relative_to(ROOT))]


RECORDED = re.compile(r'recording\.name=([\w$]+)|SimulationRecorder\(\w+, \'bags\', \'(\w+)\'\)')
LOOP = re.compile(r'for (\w+) in ([\w ]+); do')


def recorded_names(text):
    """Return the names that the commands and programs of a page record as."""
    names = [first or second for first, second in RECORDED.findall(text)]
    for variable, values in LOOP.findall(text):
        if f'${variable}' in names:
            names.remove(f'${variable}')
            names += values.split()
    return names


def test_each_recording_has_a_name_of_its_own():
    """The second command of a reader would be refused: a recording is never overwritten."""
    names = [name for page in PAGES for name in recorded_names(page.read_text(encoding='utf-8'))]
    assert len(names) > 12
    assert [name for name in names if names.count(name) > 1] == []


def test_a_scene_file_is_one_scene():
    """A page would give a file to be written that is another scene of config/."""
    ours = {path.name for path in (ROOT / 'config').glob('*.yaml')}
    bare = re.compile(r'(?<![\w/])(\w+\.yaml)')
    named = {
        name for page in PAGES for command in
        re.findall(r'^ {4}(.*)', page.read_text(encoding='utf-8'), re.MULTILINE)
        for name in bare.findall(command)}
    assert 'bath_towel.yaml' in named
    assert named & ours == set()
