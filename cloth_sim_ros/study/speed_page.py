# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The page on speed: what each bench measures, as a section with a table.

Each section is measured by the command that it shows, in a process of its own: llvmpipe takes its
number of threads once.
"""

from collections.abc import Callable
from collections.abc import Collection
from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import date
from importlib.util import find_spec
import json
import os
import platform
import shlex
import subprocess
import sys

from cloth_sim_ros.files.close_name import refuse_unknown
from cloth_sim_ros.files.errors import MOST_SHOWN
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.recording.bag_metadata import project_version
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study import speed_tables
from cloth_sim_ros.study.speed_tables import Found

# Between these lines a page holds the figures.
BEGIN = '<!-- figures: written by cloth_sim bench --page -->'
END = '<!-- end of the figures -->'
_TITLE = '## '
_ONE_THREAD = {'LP_NUM_THREADS': '0'}
_ONE_ROUND = ('--rounds', '1')
# Max. size of a list of processors [bytes]; chosen: 4 kB for each of a thousand.
_PROCESSORS_LIMIT = 2**22
# What a section may need besides the package, by module.
_NEEDS = {'rclpy': 'ROS', 'gymnasium': 'gymnasium'}


@dataclass(frozen=True)
class Section:
    """
    A section of the page.

    :param arguments: of `cloth_sim bench`, which measures it
    :param trial: further ones, with which that takes a second or two and means little
    :param text: what was measured
    :param table: makes the table of what the bench found
    :param needs: a module that the bench needs besides the package; empty for none
    :param is_on_one_thread: whether a software device has no worker threads
    """

    name: str
    title: str
    arguments: tuple[str, ...]
    trial: tuple[str, ...]
    text: str
    table: Callable[[Sequence[Found]], str]
    needs: str = ''
    is_on_one_thread: bool = False

    @property
    def command(self) -> str:
        """Return the command that measures this section alone."""
        before = [f'{name}={value}' for name, value in _ONE_THREAD.items()]
        return shlex.join([
            *(before if self.is_on_one_thread else ()), 'cloth_sim', 'bench', *self.arguments])


@dataclass(frozen=True)
class Measured:
    """
    What was measured for a section.

    :param found: a dictionary for each line of JSON; None where a module was missing
    """

    section: Section
    found: list[Found] | None

    def in_markdown(self) -> str:
        """Return the section: title, command, what was measured, when and where, and the table."""
        section = self.section
        below = (
            f'{_where(self.found)}\n\n{section.table(self.found)}' if self.found is not None
            else f'Not measured: {_NEEDS[section.needs]} is not installed here.\n')
        return (
            f'{_TITLE}{section.title}\n\n    {section.command}\n\n{section.text}\n\n{below}')


SECTIONS = (
    Section(
        'springs', 'Springs', ('--sizes', '128', '512', '1024'),
        ('--sizes', '16', *_ONE_ROUND, '--round-seconds', '0.01'),
        'Steps of all nodes a second, in mode mass_spring with all springs and damping, on all '
        'cores. `layout: fused` is the default, `layout: paper` the method as it was published.',
        speed_tables.springs),
    Section(
        'modes', 'Modes at equal stretch',
        ('--modes', '--grids', '32,48,64'),
        ('--grids', '6', *_ONE_ROUND, '--seconds', '0.04'),
        'A light cloth of 1 x 1 m and 0.15 kg falls from level while two corners are pinned, '
        '1.2 s on one thread. The settings of each mode are meant to keep its stretch near 1 %.',
        speed_tables.modes),
    Section(
        'bodies', 'Contact with bodies', ('--contact', '--seconds', '0.4'),
        ('--sizes', '6', *_ONE_ROUND, '--seconds', '0.04'),
        'A cloth falls for 0.4 s over a sphere, alone and among 19 more that it never comes near '
        'to; beside the same without a body, falling, and hung from two corners.',
        speed_tables.bodies),
    Section(
        'layers', 'Layers that touch', ('--layers', '--sizes', '32', '64'),
        ('--sizes', '8', *_ONE_ROUND, '--seconds', '0.005', '--settle', '0.005'),
        'Processor time of a simulated second of a towel on a floor, flat and folded in half, '
        'with self-contact and without.', speed_tables.layers),
    Section(
        'batch', 'Many cloths', ('--batch', '--sizes', '12', '32'),
        ('--sizes', '6', '--cloths', '2', *_ONE_ROUND),
        'Cloths that step together in a `Batch` on all cores, and as one `Simulation` after the '
        'other, each on one core.', speed_tables.cloths),
    Section(
        'environments', 'Environments', ('--environments',),
        ('--sizes', '4', '--cloths', '2', *_ONE_ROUND),
        'Steps of gymnasium environments in a second of processor time, on one core. A step is '
        '50 ms of simulated time in 10 steps of `dt`.', speed_tables.environments,
        'gymnasium', is_on_one_thread=True),
    Section(
        'camera', 'Cameras', ('--camera',), ('--sizes', '8', *_ONE_ROUND),
        'A picture of 640 x 480 pixels after each 33.3 ms of a cloth of 64 x 64 nodes in mode '
        'mass_spring.', speed_tables.camera),
    Section(
        'node', 'A node, topic by topic',
        ('--node', '--sizes', '32', '64', '--rounds', '2', '--seconds', '3'),
        ('--sizes', '8', *_ONE_ROUND, '--seconds', '0.3'),
        'Processor time of a node over that of the simulation alone, at 50 frames a second in '
        'real time, as a subscriber in another process reads one topic more in each line.',
        speed_tables.node, 'rclpy'),
    Section(
        'start_up', 'Start-up', ('--start-up', 'config/drape.yaml'), _ONE_ROUND,
        'Time from the start of a node to its first cloud at a subscriber that is there already. '
        'Shaders are compiled before: the first start of all takes longer.',
        speed_tables.start_up, 'rclpy'))


def chosen(names: Collection[str]) -> list[Section]:
    """
    Return the sections to measure.

    :param names: of sections; empty for all
    :raises ClothSimError: for a name that is none of them
    """
    refuse_unknown('section', names, (section.name for section in SECTIONS))
    return [section for section in SECTIONS if not names or section.name in names]


def measure(sections: Sequence[Section], *, is_trial: bool = False) -> Iterator[Measured]:
    """
    Measure one section after the other.

    :param is_trial: whether small and short runs do
    :raises ClothSimError: when one can't be measured
    """
    for section in sections:
        is_there = not section.needs or find_spec(section.needs) is not None
        yield Measured(section, _measure(section, is_trial) if is_there else None)


def markdown(measured: Sequence[Measured], before: str = '') -> str:
    """
    Return all sections.

    :param before: what this has returned before: its other sections stay
    """
    sections = {section.title: '' for section in SECTIONS}
    sections.update(_sections_in(before))
    sections.update({each.section.title: each.in_markdown() for each in measured})
    return '\n'.join(text for text in sections.values() if text)


def _sections_in(text: str) -> dict[str, str]:
    """Return the sections of a page that was written before, by their titles."""
    found = {}
    for part in f'\n{text}'.split(f'\n{_TITLE}')[1:]:
        title, _, rest = part.partition('\n')
        if title in {section.title for section in SECTIONS}:
            found[title] = f'{_TITLE}{title}\n{rest.rstrip()}\n'
    return found


def _where(found: Sequence[Found]) -> str:
    """Return what the figures depend on."""
    device = str(found[0].get('device', '')) if found else ''
    version = project_version() or 'that is not installed'
    cores = len(os.sched_getaffinity(0))
    where = ', '.join(filter(None, [
        device, f'{cores} cores' if cores > 1 else '1 core', processor_name()]))
    return f'Measured on {date.today().isoformat()} with version {version}, on {where}.'


def processor_name() -> str:
    """Return what the processor calls itself; empty where nobody knows."""
    try:
        text = read_regular('/proc/cpuinfo', _PROCESSORS_LIMIT).decode(errors='replace')
    except (OSError, ClothSimError):
        return platform.processor()
    for line in text.splitlines():
        if line.startswith('model name'):
            return line.partition(':')[2].strip()
    return platform.processor()


def _measure(section: Section, is_trial: bool) -> list[Found]:
    process = subprocess.Popen(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'bench', *section.arguments,
         *(section.trial if is_trial else ()), '--json'],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env={**os.environ, **(_ONE_THREAD if section.is_on_one_thread else {})})
    try:
        said, complaint = process.communicate()
    except BaseException:
        # A bench that is terminated ends its own child processes, such as a node.
        process.terminate()
        process.wait()
        raise
    if process.returncode:
        raise ClothSimError(
            f'`{section.command}` ended with exit code {process.returncode}: it said '
            f'{shown(complaint.strip()[-MOST_SHOWN:])}')
    return [json.loads(line) for line in said.splitlines()]
