# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""`cloth_sim bench` measures the layouts side by side and names the device."""

import json
import subprocess
import sys

from cloth_sim_ros.study.speed_page import BEGIN
from cloth_sim_ros.study.speed_page import END
from cloth_sim_ros.verb.main import main
import pytest


def test_the_figures_name_layout_and_device():
    """A figure without its device would be compared with another machine's."""
    done = subprocess.run(
        [sys.executable, '-m', 'cloth_sim_ros.verb', 'bench', '--json', '--rounds', '3',
         '--round-seconds', '0.02', '--sizes', '16', '48'],
        capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    small, large = map(json.loads, done.stdout.splitlines())
    assert (small['rows'], large['rows']) == (16, 48)
    assert large['device']
    fused, paper = large['speeds']
    assert (fused['layout'], paper['layout']) == ('fused', 'paper')
    assert fused['ratio_rounds'] == pytest.approx(
        [a / b for a, b in zip(fused['rounds'], paper['rounds'])])


def bench(capsys, *arguments):
    """Return the lines of a bench in this process: it takes a second to start another one."""
    capsys.readouterr()
    assert main(['bench', *arguments]) == 0
    return capsys.readouterr().out.splitlines()


def test_variants_are_scene_parameters(capsys):
    """Only the shipped comparison could be measured."""
    told, = bench(
        capsys, '--json', '--rounds', '1', '--round-seconds', '0.01', '--sizes', '16',
        '--variants', 'block=2,loads=storage', 'stiffness.bend=0.0,damping.bend=0.0')
    first, second = json.loads(told)['speeds']
    assert (first['block'], first['loads']) == (2, 'storage')
    assert second['ratio'] == 1.0


@pytest.mark.long
def test_the_solver_is_measured_with_its_error(capsys):
    """The speed of a solve would be reported without its accuracy."""
    device, *lines = bench(
        capsys, '--solver', '--rounds', '1', '--round-seconds', '0.001', '--sizes', '10')
    assert device.startswith('10 x 10 on ')
    assert len(lines) == 12
    assert all('solves/s' in line and 'dv off by' in line for line in lines)


def test_the_paper_solver_is_a_named_baseline(capsys):
    """The ratio to the paper could not be measured again."""
    told, = bench(
        capsys, '--solver', '--baseline', 'paper', '--json', '--rounds', '1', '--round-seconds',
        '0.001', '--sizes', '10')
    comparison = json.loads(told)
    assert {speed['solver'] for speed in comparison['speeds']} == {'multigrid', 'paper'}
    assert len(comparison['ratios']) == 6


SHORT_MODES = ('--modes', '--seconds', '0.06', '--rounds', '2')


def test_modes_are_compared_in_one_document(capsys):
    """Programs could not read the comparison, or the machine it was made on."""
    found = json.loads(''.join(bench(capsys, *SHORT_MODES, '--grids', '6,10', '--json')))
    assert [(row['grid'], row['contender']) for row in found['speeds']] == [
        (grid, name) for grid in (6, 10) for name in (
            'mass_spring', 'stiffer_springs', 'constraint', 'adaptive')]
    assert found['device'] and found['worker_threads'] == '0'
    assert {'cloth_sim_ros', 'OpenGL', 'numpy'} <= set(found['versions'])
    for row in found['speeds']:
        assert 0.0 <= row['stretch']['worst_frame_percentile'] <= row['stretch']['peak']
        assert len(row['ratios']) == 2 and row['processor_ratio'] > 0.0
    assert (found['seconds'], found['rounds']) == (pytest.approx(0.06), 2)


def test_some_modes_can_be_compared_alone(capsys):
    """A change of one mode would be measured with all others beside it."""
    lines = bench(
        capsys, *SHORT_MODES, '--grids', '6', '--only', 'adaptive', 'mass_spring')
    rows = [line.split('|') for line in lines if line.startswith('| 6 ')]
    assert [row[2].strip() for row in rows] == ['adaptive', 'mass_spring']
    assert not any('Wall time grows' in line for line in lines)


@pytest.mark.parametrize(('arguments', 'reason'), [
    (['--grids', '6,ten'], "'6,ten' is not a list of integers: write it as in 32,64"),
    (['--grids', '6', '--only', 'magic'], 'mass_spring'),
    (['--grids', '1'], 'at least 2'), (['--grids', '6', '--seconds', 'nan'], 'nan s'),
    (['--grids', '6', '--rounds', '0'], '0 rounds')])
def test_a_comparison_that_makes_no_sense_is_refused(arguments, reason, capsys):
    """A slip of the keyboard would end in a traceback."""
    try:
        code = main(['bench', *SHORT_MODES, *arguments])
    except SystemExit as end:
        code = end.code
    told = capsys.readouterr().err
    assert code != 0 and reason in told
    assert 'Traceback' not in told


def test_colliders_are_compared_with_none(capsys):
    """The cost of contact would be that of other work, or be missing."""
    found = [json.loads(line) for line in bench(
        capsys, '--contact', '--sizes', '6', '--seconds', '0.04', '--rounds', '1', '--json')]
    assert [each['mode'] for each in found] == ['mass_spring', 'constraint']
    for each in found:
        names = ['no collider', 'a sphere', '20 spheres', 'hung, no collider']
        assert list(each['ratios']) == list(each['ratios_to_hung']) == names
        assert each['ratios']['no collider'] == [1.0]
        assert each['ratios_to_hung']['hung, no collider'] == [1.0]


def test_a_page_is_written(tmp_path, capsys):
    """The page would have to be put together by hand."""
    page = tmp_path / 'speed.md'
    page.write_text(f'# Mine\n\n{BEGIN}\n{END}\n\nkept\n', encoding='utf-8')
    lines = bench(capsys, '--page', str(page), '--quick', '--only', 'springs', 'camera')
    text = page.read_text(encoding='utf-8')
    assert text.startswith('# Mine') and text.endswith('kept\n')
    assert all(line in text for line in lines)
    assert [line for line in text.splitlines() if line.startswith('## ')] == [
        '## Springs', '## Cameras']


@pytest.mark.parametrize(('arguments', 'reason'), [
    (['--only', 'sprngs'], 'did you mean springs'), ([], 'can not be written')])
def test_a_page_that_can_not_be_made_is_refused(arguments, reason, tmp_path, capsys):
    """The user would learn so after ten minutes."""
    assert main(['bench', '--page', str(tmp_path / 'none' / 'speed.md'), *arguments]) == 1
    assert reason in capsys.readouterr().err
