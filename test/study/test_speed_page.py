# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page on speed: its sections, their commands and tables."""

from argparse import ArgumentParser
from pathlib import Path
import shlex

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study import speed_page
from cloth_sim_ros.study.speed_page import chosen
from cloth_sim_ros.study.speed_page import markdown
from cloth_sim_ros.study.speed_page import measure
from cloth_sim_ros.study.speed_page import Section
from cloth_sim_ros.study.speed_page import SECTIONS
from cloth_sim_ros.study.speed_tables import figure
from cloth_sim_ros.verb.bench import add_arguments
import pytest

PAGE = Path(__file__).parents[2] / 'docs' / 'speed.md'
NAMES = [section.name for section in SECTIONS]


def test_a_figure_is_a_median_with_its_range():
    """A figure of a busy round would be taken for that of the device."""
    assert figure([3.0, 1.0, 200.0]) == '3 (1 to 200)'
    assert figure([0.0012344], 1e3) == '1.23'
    assert figure([999.6, 999.4]) == '1,000 (999 to 1,000)'


def test_an_unknown_section_is_refused():
    """A typing error would measure nothing, and the page be empty."""
    assert [section.name for section in chosen([])] == NAMES
    assert [section.name for section in chosen(['node', 'springs'])] == ['springs', 'node']
    with pytest.raises(ClothSimError, match="no section 'spring': did you mean springs"):
        chosen(['spring'])
    with pytest.raises(ClothSimError, match='take one of springs, modes'):
        chosen(['everything'])


@pytest.mark.parametrize('section', SECTIONS, ids=NAMES)
def test_the_page_shows_what_is_measured(section):
    """A reader would call a command that measures something else, or miss a section."""
    page = PAGE.read_text(encoding='utf-8')
    assert f'## {section.title}\n\n    {section.command}\n\n{section.text}\n' in page
    parser = ArgumentParser()
    add_arguments(parser)
    words = shlex.split(section.command)
    parser.parse_args(words[words.index('bench') + 1:])


def test_the_page_names_device_version_and_date():
    """A figure would be compared with that of another machine."""
    page = PAGE.read_text(encoding='utf-8')
    assert speed_page.BEGIN in page and speed_page.END in page
    assert page.count('Measured on 20') == page.count('\n## ') == len(SECTIONS)


@pytest.mark.parametrize('name', [
    'springs', 'camera', 'batch', 'environments',
    *(pytest.param(each, marks=pytest.mark.long) for each in (
        'modes', 'bodies', 'layers', 'node'))])
def test_a_section_has_a_table(name):
    """The page would need ten minutes to find out that a table can't be made."""
    [measured] = measure(chosen([name]), is_trial=True)
    text = markdown([measured])
    assert 'Measured on 20' in text and f'    {measured.section.command}\n' in text
    head, line, *rows = [each for each in text.splitlines() if each.startswith('|')]
    assert rows and {each.count('|') for each in (line, *rows)} == {head.count('|')}


def test_a_section_without_its_module_says_so(monkeypatch):
    """Where there is no ROS, the other sections could not be measured."""
    monkeypatch.setattr(speed_page, 'find_spec', lambda _: None)
    text = markdown(list(measure(chosen(['environments', 'node', 'start_up']))))
    assert text.count('Not measured: ROS is not installed here.') == 2
    assert 'Not measured: gymnasium is not installed here.' in text


def test_sections_that_are_not_measured_again_stay(monkeypatch):
    """To measure one section again would cost all others."""
    monkeypatch.setattr(speed_page, 'find_spec', lambda _: None)
    before = markdown(list(measure(chosen(['environments', 'node']))))
    node = before[before.index('## A node'):]
    kept = before.replace('Not measured: ROS', 'Kept: ROS').replace('gymnasium is not', 'X is not')
    again = markdown(list(measure(chosen(['environments']))), kept)
    assert again == before.replace(node, node.replace('Not measured: ROS', 'Kept: ROS'))
    later = markdown(list(measure(chosen(['start_up']))), f'\n\n{kept}\n')
    assert later.startswith(kept) and later.count('## ') == 3


def test_a_section_that_fails_is_named():
    """The page would lack a table, or end in a traceback, without a reason."""
    section = Section('wrong', 'Wrong', ('--rounds', '0'), (), '', str)
    with pytest.raises(ClothSimError, match='bench --rounds 0.*give 1 or more'):
        list(measure([section]))
