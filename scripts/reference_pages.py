#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Write the generated pages of docs/reference from the tables of the code.

    python scripts/reference_pages.py          writes them
    python scripts/reference_pages.py --check  exits with 1 when a page is out of date
"""

from argparse import Action
from argparse import ArgumentParser
from argparse import PARSER
from argparse import SUPPRESS
import ast
from collections.abc import Iterable
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
import sys

from cloth_sim_ros.messages.requests import ACTIONS
from cloth_sim_ros.messages.requests import Request
from cloth_sim_ros.messages.requests import SERVICES
from cloth_sim_ros.messages.requests import SUBSCRIPTIONS
from cloth_sim_ros.messages.topics import camera_topics
from cloth_sim_ros.messages.topics import RECORDED_PARTS
from cloth_sim_ros.messages.topics import Topic
from cloth_sim_ros.messages.topics import TOPICS
from cloth_sim_ros.node.node_fields import NODE_FIELDS
from cloth_sim_ros.sim.model.cameras import CAMERA_FIELDS
from cloth_sim_ros.sim.model.colliders import COLLIDER_FIELDS
from cloth_sim_ros.sim.model.scene_fields import Field
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.verb.main import VERBS
from python_reference import python_page

ROOT = Path(__file__).resolve().parents[1]
REFERENCE = ROOT / 'docs' / 'reference'
INTERFACES = ROOT / 'cloth_sim_interfaces'
LAUNCH_FILE = ROOT / 'launch' / 'cloth_sim.launch.py'
NOTE = '<!-- Written by scripts/reference_pages.py from the code: edit it there. -->\n'
_WORDS = {bool: 'bool', int: 'int', float: 'float', str: 'string'}


def pages() -> dict[str, str]:
    """Return the text of every generated page by its name."""
    return {
        'parameters.md': parameters_page(), 'topics.md': topics_page(),
        'services.md': services_page(), 'verbs.md': verbs_page(), 'launch.md': launch_page(),
        'python.md': python_page(NOTE)}


def table(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """Return a Markdown table."""
    header = list(header)
    lines = [header, ['---'] * len(header), *(list(row) for row in rows)]
    return ''.join(f'| {" | ".join(line)} |\n' for line in lines)


def parameters_page() -> str:
    """Return the page of all parameters."""
    header = ('name', 'type', 'default', 'range', 'description')
    return f"""{NOTE}
# Parameters

A scene file is a ROS parameter file. The node reads all of these parameters, and `cloth_sim run`
reads the same files. Most parameters can only be set when the node starts. Those that are marked
can be changed while it runs, with `ros2 param set`. `ros2 param describe /cloth_sim NAME` prints
the same descriptions.

Write decimal points in lists of numbers: ROS accepts `[0.0, 0.0, 1.5]` and refuses `[0, 0, 1.5]`.

## Scene

{table(header, map(parameter_cells, SCENE_FIELDS))}
## Colliders

Each name in `colliders.names` has these, with the name instead of NAME
([contact](../how_to/contact.md)):

{table(header, map(parameter_cells, COLLIDER_FIELDS))}
## Cameras

Each name in `cameras.names` has these, with the name instead of NAME
([cameras](../how_to/cameras.md)):

{table(header, map(parameter_cells, CAMERA_FIELDS))}
## Node

{table(header, map(parameter_cells, NODE_FIELDS))}"""


def parameter_cells(field: Field) -> list[str]:
    """Return the cells of one parameter."""
    unit = f' [{field.unit}]' if field.unit else ''
    live = '; can be changed while the node runs' if field.live else ''
    return [
        f'`{field.name}`',
        _WORDS[field.kind] + ('[]' if field.is_array else ' or two' if field.is_pair else ''),
        f'`{value(field.default)}`',
        range_of(field),
        f'{field.text}{unit}{live}']


def range_of(field: Field) -> str:
    """Return the values that are allowed."""
    if field.choices:
        return ', '.join(f'`{choice}`' for choice in field.choices)
    if field.low is None or field.high is None:
        return ''
    if field.kind is int:
        return f'{field.low} to {field.high}'
    return f'{field.low:g} to {field.high:g}'


def value(default: object) -> str:
    """Return a default as it is written in YAML."""
    if isinstance(default, tuple):
        return f'[{", ".join(value(part) for part in default)}]'
    if isinstance(default, bool):
        return str(default).lower()
    return str(default) if default != '' else "''"


def topics_page() -> str:
    """Return the page of the topics and their message types."""
    header = ('topic', 'type', 'quality of service', 'recorded', 'description')
    kinds = [topic.message for topic in TOPICS.values()] + [each.kind for each in SUBSCRIPTIONS]
    return f"""{NOTE}
# Topics

`~` stands for the name of the node, `/cloth_sim` by default. [ROS interface](ros_interface.md)
explains frames, stamps, the fields of a point, wrenches, and how large messages are delivered.

## Published

A message is only made while the topic has a subscriber or a recording is running.

{table(header, map(topic_cells, TOPICS.values()))}
## Published of each camera

With the name of the camera instead of NAME ([cameras](../how_to/cameras.md)):

{table(header, map(topic_cells, camera_topics(['NAME']).values()))}
## Subscribed

{table(('topic', 'type', 'description'), map(request_cells, SUBSCRIPTIONS))}
## Message types

{definitions(kinds, 'msg')}"""


def topic_cells(topic: Topic) -> list[str]:
    """Return the cells of one published topic."""
    reliability = 'reliable' if topic.reliable else 'best effort'
    durability = 'transient local' if topic.transient_local else 'volatile'
    return [
        f'`{topic.name}`', f'`{topic.type_name}`', f'{reliability}, {durability}, {topic.depth}',
        recorded(topic), topic.text]


def recorded(topic: Topic) -> str:
    """Return when a recording has a topic."""
    if topic.recorded:
        return 'yes'
    if not topic.key.startswith('cameras/'):
        return 'with `recording.markers`'
    return 'with `recording.cameras`' if topic.key.rpartition('/')[2] in RECORDED_PARTS else 'no'


def request_cells(request: Request) -> list[str]:
    """Return the cells of one service or subscribed topic."""
    return [f'`{request.name}`', f'`{request.type_name}`', request.text]


def services_page() -> str:
    """Return the page of the services and actions, and their types."""
    return f"""{NOTE}
# Services and actions

`~` stands for the name of the node, `/cloth_sim` by default. Every answer has `success` and
`message`, and those of the project's own types a [code](ros_interface.md#codes). A request that
cannot be carried out changes nothing: `success` is false, and `message` gives the rule, the value
and a way out. [ROS interface](ros_interface.md) explains when a request
takes effect.

{table(('service', 'type', 'description'), map(request_cells, SERVICES))}
## Actions

[ROS interface](ros_interface.md#actions) explains when they end.

{table(('action', 'type', 'description'), map(request_cells, ACTIONS))}
## Service types

{definitions([service.kind for service in SERVICES], 'srv')}
## Action types

{definitions([action.kind for action in ACTIONS], 'action')}"""


def definitions(kinds: Iterable[type], part: str) -> str:
    """Return the definitions of the project's own interfaces among ``kinds``."""
    names = {kind.__name__ for kind in kinds if kind.__module__.startswith(INTERFACES.name)}
    return '\n'.join(
        f'### {INTERFACES.name}/{part}/{name}\n\n```text\n'
        f'{(INTERFACES / part / f"{name}.{part}").read_text(encoding="utf-8")}```\n'
        for name in sorted(names))


def verbs_page() -> str:
    """Return the page of the command line."""
    sections = ''.join(map(verb_section, VERBS))
    summary = table(('verb', 'description'), (
        [f'[`cloth_sim {name}`](#cloth_sim-{name})', text] for name, text in VERBS.items()))
    return f"""{NOTE}
# Command line

`cloth_sim VERB --help` prints the same texts. Verbs that talk to a node end with exit code 1 and
a reason when none answers within `--timeout`.

{summary}
{sections}""".rstrip() + '\n'


def verb_section(name: str) -> str:
    """Return what there is to say about one verb."""
    verb = import_module(f'cloth_sim_ros.verb.{name}')
    parser = ArgumentParser(prog=f'cloth_sim {name}', add_help=False)
    verb.add_arguments(parser)
    return f'## cloth_sim {name}\n\n{help_text(verb.__doc__)}\n{arguments_of(parser, 3)}'


def help_text(text: str) -> str:
    """Return a help text in Markdown: what is indented is a command or its output."""
    return ''.join(
        f'    {line[2:]}\n' if line.startswith('  ') else
        f'{line}\n\n' if line.endswith(':') else f'{line}\n'
        for line in text.strip().splitlines())


def arguments_of(parser: ArgumentParser, level: int) -> str:
    """Return the arguments of ``parser``, and those of its commands under headings."""
    rows, below = [], ''
    for action in parser._actions:
        if action.help == SUPPRESS:
            continue
        if action.nargs == PARSER:
            short = {each.dest: sentence(each.help) for each in action._choices_actions}
            for name, own in action.choices.items():
                text = help_text(own.description or short[name]).rstrip()
                below += (
                    f'{"#" * level} {parser.prog} {name}\n\n{text}\n\n'
                    f'{arguments_of(own, level + 1)}')
        elif '--help' not in action.option_strings:
            rows.append([argument(action), cell((action.help or '') % vars_of(parser, action))])
    listed = f'{table(("argument", "description"), rows)}\n' if rows else ''
    return f'{listed}{below}'


def vars_of(parser: ArgumentParser, action: Action) -> dict[str, object]:
    """Return what a help text may refer to."""
    return {**vars(action), 'prog': parser.prog}


def argument(action: Action) -> str:
    """Return how an argument is given."""
    metavar = action.metavar or (
        '{' + ','.join(map(str, action.choices)) + '}' if action.choices else action.dest.upper())
    values = ' '.join(metavar) if isinstance(metavar, tuple) else metavar
    if action.nargs == 0:
        values = ''
    elif action.nargs in ('+', '*'):
        values += ' ...'
    name = ', '.join(action.option_strings)
    return f'`{cell(" ".join(part for part in (name, values) if part))}`'


def sentence(text: str) -> str:
    """Return a help text as a sentence."""
    return f'{text[:1].upper()}{text[1:]}.'


def cell(text: str) -> str:
    """Return ``text`` as it can stand in a table."""
    return ' '.join(text.split()).replace('|', '\\|')


def launch_page() -> str:
    """Return the page of the launch file."""
    return f"""{NOTE}
# Launch file

    ros2 launch cloth_sim_ros cloth_sim.launch.py rviz:=true recording:=true

{table(('argument', 'default', 'description'), launch_cells())}
`ros2 launch cloth_sim_ros cloth_sim.launch.py --show-args` prints the same descriptions.
"""


def launch_cells() -> Iterator[list[str]]:
    """Yield the cells of each argument, without the need of ROS's launch."""
    for node in ast.walk(ast.parse(LAUNCH_FILE.read_text(encoding='utf-8'))):
        if isinstance(node, ast.Call) and getattr(node.func, 'id', '') == 'DeclareLaunchArgument':
            given = {keyword.arg: keyword.value for keyword in node.keywords}
            default = given['default_value']
            if isinstance(default, ast.Call):
                shown = f'`config/{ast.literal_eval(default.args[0])}` of the package'
            else:
                text = '' if isinstance(default, ast.Name) else ast.literal_eval(default)
                shown = f'`{text}`' if text else ''
            yield [f'`{ast.literal_eval(node.args[0])}`', shown,
                   ast.literal_eval(given['description'])]


def main() -> int:
    """Write or check the pages."""
    stale = [
        name for name, text in pages().items()
        if not (REFERENCE / name).is_file()
        or (REFERENCE / name).read_text(encoding='utf-8') != text]
    if sys.argv[1:] == ['--check']:
        for name in stale:
            print(f'docs/reference/{name} is out of date: run python scripts/reference_pages.py',
                  file=sys.stderr)
        return int(bool(stale))
    for name in stale:
        (REFERENCE / name).write_text(pages()[name], encoding='utf-8')
    return 0


if __name__ == '__main__':
    sys.exit(main())
