# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Making the paper's figures from the command line."""

from contextlib import redirect_stdout
from io import StringIO

from cloth_sim_ros.study.paper_figures import FIGURES
from cloth_sim_ros.verb.main import main
from PIL import Image
import pytest
from recorded import Recorded

SECONDS = 0.4  # the cloth that blows up does so after 0.3 s


@pytest.fixture(scope='module')
def told(tmp_path_factory):
    """Make both figures, for a short time; return the folder of each and what was printed."""
    result = {}
    for figure in FIGURES:
        folder = tmp_path_factory.mktemp(figure)
        with redirect_stdout(StringIO()) as out:
            assert main([
                'paper', figure, '--out', str(folder), '--seconds', str(SECONDS),
                '--at', '0.1,0.4']) == 0
        result[figure] = folder, out.getvalue().splitlines()
    return result


@pytest.fixture(scope='module')
def made(told):
    """Return the folder of each figure."""
    return {figure: folder for figure, (folder, _) in told.items()}


@pytest.fixture(scope='module')
def stats(made):
    """Return the recorded numbers of each run, by figure and name."""
    return {
        (figure, run.name): Recorded(made[figure] / run.name).messages('stats')
        for figure in FIGURES for run in FIGURES[figure].runs}


def test_every_run_is_a_recording_with_its_settings(made, stats):
    """A row would show another run than its label says."""
    for figure, folder in made.items():
        for run in FIGURES[figure].runs:
            parameters = Recorded(folder / run.name).messages('inputs/parameters')[0]
            recorded = {
                parameter.name: parameter.value for parameter in parameters.new_parameters}
            mode = run.changes.get('mode', 'mass_spring')
            assert recorded['mode'].string_value == mode
            dt = run.changes.get('dt', 0.005)
            assert recorded['dt'].double_value == dt
            assert {message.dt for message in stats[figure, run.name]} == {dt}
            assert recorded['auto_substeps'].bool_value == run.changes.get('auto_substeps', True)


def test_the_sheet_has_a_row_for_each_run(made):
    """A run would be missing from the picture."""
    heights = {
        figure: Image.open(folder / f'{figure}.png').size[1] for figure, folder in made.items()}
    rows = {figure: len(FIGURES[figure].runs) for figure in FIGURES}
    per_row = (heights['fig11'] - heights['fig10']) / (rows['fig11'] - rows['fig10'])
    assert 200 < per_row < heights['fig10'] / rows['fig10']


def test_only_the_run_beyond_the_limit_stops(made, stats):
    """A blow-up would be passed off as a run, or a run as a blow-up."""
    for (figure, name), messages in stats.items():
        states = Recorded(made[figure] / name).messages('state')
        stopped = states[-1].run_state == 'stopped'
        assert stopped == (name == 'stiff_paper')
        end = messages[-1].sim_time
        assert (0.2 < end < SECONDS) if stopped else end == pytest.approx(SECONDS)


@pytest.mark.parametrize('figure, name', [
    ('fig10', 'stiff_paper'), ('fig11', 'adaptive_paper_dt_0.02')])
def test_a_run_beyond_the_limit_can_be_made_again(made, capsys, figure, name):
    """A blow-up could be looked at, but not be made again, as its step is refused elsewhere."""
    assert main(['resimulate', str(made[figure] / name)]) == 0
    out = capsys.readouterr().out
    assert 'frames bitwise identical' in out
    assert ('as the recorded one did' in out) == (name == 'stiff_paper')


def test_the_reason_of_a_stop_is_told(told):
    """A user would have to guess why a row of the picture ends."""
    _, out = told['fig10']
    assert 'the substep is 1.11 times the stability limit' in out[0]


@pytest.mark.parametrize('figure', FIGURES)
def test_the_table_says_what_the_recordings_hold(told, stats, figure):
    """The page would show numbers of other runs than can be looked at."""
    folder, out = told[figure]
    assert out[-1] == str(folder / f'{figure}.png')
    rows = [line.strip('| ').split(' | ') for line in out if line.startswith('|')][2:]
    for run, row in zip(FIGURES[figure].runs, rows, strict=True):
        messages = stats[figure, run.name]
        strain = max(message.max_strain for message in messages)
        energy = max(message.kinetic_energy for message in messages)
        assert row[0] == run.label
        assert float(row[1]) == messages[-1].dt
        assert float(row[3].rstrip(' %')) == pytest.approx(100.0 * strain, rel=5e-3, abs=1e-9)
        assert float(row[5]) == pytest.approx(energy, rel=1e-3)
        assert ('not finite' in row[6]) == (run.name == 'stiff_paper')


def test_no_recording_is_overwritten(made, capsys):
    """The figures of yesterday would be lost."""
    assert main(['paper', 'fig10', '--out', str(made['fig10'])]) == 1
    assert 'another folder with --out' in capsys.readouterr().err


def test_an_unknown_parameter_is_refused(tmp_path, capsys):
    """A mistyped change would be passed over."""
    folder = tmp_path / 'figure'
    assert main(['paper', 'fig11', '--out', str(folder), '--set', 'stiffnes.bend=1.0']) == 1
    assert 'stiffness.bend' in capsys.readouterr().err
    assert not folder.exists()
