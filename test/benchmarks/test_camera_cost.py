# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cost of pictures is measured for each row of its page."""

from pathlib import Path

from camera_cost import main
from camera_cost import PICTURES

PAGE = Path(__file__).resolve().parents[2] / 'docs/how_to/cameras.md'


def test_each_row_of_the_page_is_measured(capsys):
    """The page would have figures that no command makes."""
    main(['--nodes', '8', '--size', '32', '24', '--rounds', '1'])
    rows = [line.split(' | ')[0] for line in capsys.readouterr().out.splitlines()[2:]]
    assert rows == [f'| {name}' for name in PICTURES]
    page = PAGE.read_text(encoding='utf-8')
    assert all(f'{row} | ' in page for row in rows)
