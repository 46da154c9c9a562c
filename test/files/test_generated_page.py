# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a command writes into a page of the docs."""

from cloth_sim_ros.files.generated_page import GeneratedPage
from cloth_sim_ros.sim.errors import ClothSimError
import pytest

LINES = BEGIN, END = '<!-- written from here -->', '<!-- to here -->'


def test_a_page_keeps_its_text(tmp_path):
    """What people have written round the table would be lost."""
    page = tmp_path / 'page.md'
    page.write_text(f'before\n\n{BEGIN}\n\nold\n{END}\n\nafter\n', encoding='utf-8')
    GeneratedPage(page, *LINES).write('new\n')
    assert page.read_text(encoding='utf-8') == f'before\n\n{BEGIN}\n\nnew\n\n{END}\n\nafter\n'


def test_a_new_page_has_both_lines(tmp_path):
    """It could not be written a second time."""
    page = tmp_path / 'new.md'
    GeneratedPage(page, *LINES).write('new\n')
    assert page.read_text(encoding='utf-8') == f'{BEGIN}\n\nnew\n\n{END}\n'


def test_one_line_alone_is_refused(tmp_path):
    """The rest of the page would be written over."""
    page = tmp_path / 'page.md'
    page.write_text(f'{BEGIN}\n', encoding='utf-8')
    with pytest.raises(ClothSimError, match='one of the two lines'):
        GeneratedPage(page, *LINES)
    assert page.read_text(encoding='utf-8') == f'{BEGIN}\n'


def test_a_place_that_is_not_there_is_named(tmp_path):
    """The command would measure for minutes, and end in a traceback."""
    with pytest.raises(ClothSimError, match='can not be written'):
        GeneratedPage(tmp_path / 'none' / 'page.md', *LINES)
