# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Steps of many environments are measured beside those of one after the other."""

from pathlib import Path

from environments import main

PAGE = Path(__file__).resolve().parents[2] / 'docs/how_to/gymnasium.md'


def test_each_size_of_the_page_is_measured(capsys):
    """The page would have figures that no command makes."""
    main(['--nodes', '4', '--count', '2', '--rounds', '1'])
    header, line, row = capsys.readouterr().out.splitlines()
    page = PAGE.read_text(encoding='utf-8')
    assert header in page and row.startswith('| 4 x 4 | ')
    assert all(f'| {nodes} x {nodes} | ' in page for nodes in (8, 16, 32))
