# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Timing the paper's cloths from the command line."""

import json

from cloth_sim_ros.study.paper.contenders import CONTENDERS
from cloth_sim_ros.verb.main import main
from cloth_sim_ros.verb.paper import FIGURES
from PIL import Image
import pytest

SHORT = ('--rounds', '2', '--turn-seconds', '0.001')


@pytest.mark.long
def test_the_table_has_a_row_for_each_program(capsys):
    """A program would be missing from the table, or printed beside another cloth."""
    assert main(['paper', 'table10', '--methods', 'constraint', '--sizes', '7', '12', *SHORT]) == 0
    out = capsys.readouterr().out
    rows = [[cell.strip() for cell in line.strip('|').split('|')]
            for line in out.splitlines() if line.startswith('|')][2:]
    names = [each.name for each in CONTENDERS['constraint']]
    assert [row[4] for row in rows] == 2 * names
    assert rows[0][:4] == ['49', '226', '-', '-']
    assert rows[len(names)][:4] == ['144', '746', '32, 2787', '87']
    assert all(float(row[5].split()[0].replace(',', '')) > 0.0 for row in rows)
    assert 'constraint: Time of a frame grows with the nodes to the power of: ' in out


def test_all_methods_are_in_one_document(capsys):
    """Programs could not read the table."""
    assert main(['paper', 'table10', '--sizes', '6', '--json', *SHORT]) == 0
    found = json.loads(capsys.readouterr().out)
    assert [cloth['method'] for cloth in found['cloths']] == list(CONTENDERS)
    for cloth in found['cloths']:
        assert cloth['device'] and len(cloth['speeds'][0]['rounds']) == 2
    assert set(found['growth']) == set(CONTENDERS)


def test_a_figure_is_drawn(tmp_path, capsys):
    """The picture would be missing, or of another method."""
    path = tmp_path / 'figure.png'
    assert main(['paper', 'fig7', '--sizes', '6', '--plot', str(path), *SHORT]) == 0
    out = capsys.readouterr().out
    assert out.splitlines()[-1] == str(path)
    assert 'mass_spring, on ' in out and 'constraint, on ' not in out
    assert Image.open(path).format == 'PNG'


@pytest.mark.parametrize('arguments, reason', [
    (['table10', '--rounds', '0'], '--rounds must be 1 to 1000'),
    (['table10', '--turn-seconds', '0'], '--turn-seconds must be finite and above 0'),
    (['table10', '--row-seconds', 'nan'], '--row-seconds must be finite and above 0'),
    (['fig8', '--sizes', '2'], '3 to 4096 nodes along each side'),
])
def test_bad_input_is_refused(arguments, reason, capsys):
    """A slip of the keyboard would cost minutes, or end in a traceback."""
    assert main(['paper', *arguments]) == 1
    assert reason in capsys.readouterr().err


@pytest.mark.parametrize('arguments', [
    ['fig12'], ['fig8', '--methods', 'adaptive'], ['table10', '--plot', 'table.png'],
    ['table10', '--methods', 'springs']])
def test_what_there_is_not_is_refused(arguments, capsys):
    """An option would be passed over, or another figure made than the one asked for."""
    with pytest.raises(SystemExit):
        main(['paper', *arguments])
    assert arguments[-1] in capsys.readouterr().err


def test_every_figure_has_its_help(capsys):
    """A user would not know which options a figure has."""
    for figure in FIGURES:
        with pytest.raises(SystemExit) as end:
            main(['paper', figure, '--help'])
        assert end.value.code == 0
        assert f'cloth_sim paper {figure}' in capsys.readouterr().out
