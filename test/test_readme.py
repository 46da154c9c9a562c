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


"""What README.md says is so."""

from argparse import ArgumentParser
from importlib import import_module
from pathlib import Path
import re
import shlex
import subprocess
import sys

from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.missing_module import BUILD_COMMAND
from cloth_sim_ros.verb.main import VERBS
import pytest

ROOT = Path(__file__).resolve().parents[1]
README = (ROOT / 'README.md').read_text(encoding='utf-8')
PAGES = [ROOT / 'README.md', ROOT / 'bags' / 'README.md', *sorted((ROOT / 'docs').rglob('*.md'))]
COMMAND = re.compile(r'^ {4}(cloth_sim [^#\n]*)', re.MULTILINE)
PICTURE = re.compile(r'!\[[^]]*\]\(([^)]+)\)')
CONTINUED = re.compile(r'\\\n *')
COMMANDS = sorted({
    command.strip() for page in PAGES
    for command in COMMAND.findall(CONTINUED.sub(' ', page.read_text(encoding='utf-8')))})


def rows(heading):
    """Return the cells of the table below a heading, without the header."""
    lines = README.partition(f'\n## {heading}\n')[2].partition('\n## ')[0].splitlines()
    table = [line.strip('| ').split(' | ') for line in lines if line.startswith('| `')]
    return [[cell.strip('`') for cell in row] for row in table]


def test_parameters_are_those_of_the_code():
    """The tables would lack a parameter, or tell an old default."""
    done = subprocess.run(
        [sys.executable, ROOT / 'scripts' / 'readme_tables.py', '--check'],
        capture_output=True, text=True)
    assert done.returncode == 0, done.stderr


def test_topics_are_those_of_the_code():
    """The table would lack a topic, or give another type."""
    assert {row[0]: row[1] for row in rows('Topics')} == {
        topic.name: topic.type_name for topic in TOPICS.values()}


def test_services_are_those_of_the_code():
    """The table would lack a service, or give another type."""
    made = re.compile(r"(?:create_service\(|serve_later\(\w+, )(\w+), '(~/\w+)'")
    served = {
        name: kind for path in (ROOT / 'cloth_sim_ros' / 'node').glob('*.py')
        for kind, name in made.findall(path.read_text(encoding='utf-8'))}
    assert {row[0]: row[1].rpartition('/')[2] for row in rows('Services')} == served


def test_every_verb_is_told():
    """A user would not learn of a verb."""
    told = {word for row in rows("With the project's own environment")
            for word in re.findall(r'cloth_sim (\w+)', row[0])}
    assert told == set(VERBS)


def test_launch_arguments_are_those_of_the_launch_file():
    """An argument would be missing, or not work."""
    text = (ROOT / 'launch' / 'cloth_sim.launch.py').read_text(encoding='utf-8')
    declared = re.findall(r"DeclareLaunchArgument\(\s*'(\w+)'", text)
    assert [row[0] for row in rows('In a ROS 2 workspace')] == declared


def test_the_workspace_command_is_the_one_the_node_tells():
    """Two commands would be told for one thing, and one of them never tried."""
    assert f'\n    {BUILD_COMMAND}\n' in README


@pytest.mark.parametrize('command', COMMANDS)
def test_commands_can_be_typed_as_they_stand(command):
    """A command of the pages would be refused."""
    _, name, *arguments = shlex.split(command)
    verb = import_module(f'cloth_sim_ros.verb.{name}')
    parser = ArgumentParser()
    verb.add_arguments(parser)
    parser.parse_args(arguments)


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
    options = ('--out', '--sheet', '--figure')
    assert any(f'{option} {name}' in text for text in pages.values() for option in options)
    assert figure.stat().st_size < 500_000


@pytest.mark.parametrize(
    'scene', sorted([*(ROOT / 'config').glob('*.yaml'), *(ROOT / 'config' / 'paper').glob('*')]),
    ids=lambda p: p.name)
def test_every_scene_is_told(scene):
    """A user would not learn of a scene."""
    assert f'`{scene.relative_to(ROOT)}`' in README
