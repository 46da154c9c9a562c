# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Measured stability limits match the closed forms, and points are distinguished."""

from cloth_sim_ros.sim.model.stability import stability_limit
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.make_runs import perform
from cloth_sim_ros.study.results import LINES
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.stability import edges
from cloth_sim_ros.study.stability import map_points
from cloth_sim_ros.study.stability_figures import draw_edges
from cloth_sim_ros.study.stability_figures import draw_maps
from cloth_sim_ros.study.stability_figures import map_legend
from cloth_sim_ros.study.stability_runs import edge_table
from cloth_sim_ros.study.stability_runs import map_table
from cloth_sim_ros.study.stability_runs import run_edge
from cloth_sim_ros.study.stability_runs import run_point
from cloth_sim_ros.study.workers import Workers
import numpy as np
import pytest

FAMILIES = ('structural', 'shear', 'bend')
UNDAMPED = {f'damping.{family}': 0.0 for family in FAMILIES}
SCENES = {
    'undamped': {**UNDAMPED, 'rows': 16, 'cols': 16},
    'damped': {
        'rows': 16, 'cols': 16, 'node_mass': 8e-4,
        **{f'damping.{family}': 0.1 for family in FAMILIES}},
    'damped fabric': {
        'rows': 16, 'cols': 16, 'damping.structural': 0.1, 'damping.shear': 0.1},
    'ruled by damping': {
        'rows': 16, 'cols': 16, 'node_mass': 8e-4,
        **{f'damping.{family}': 1.0 for family in FAMILIES}},
    'oblong cells': {**UNDAMPED, 'rows': 14, 'cols': 20, 'width': 3.0},
    'chain': {'rows': 1, 'cols': 40, 'damping.structural': 0.02},
    'unlike families': {'rows': 16, 'cols': 16, 'stiffness.bend': 400.0, 'damping.shear': 0.05},
}
SMALL = {'rows': 6, 'cols': 6, 'dt': 0.01}


@pytest.mark.parametrize(('name', 'mode'), [
    *((name, 'mass_spring') for name in SCENES), ('damped', 'adaptive'),
    *(pytest.param(name, 'adaptive', marks=pytest.mark.long) for name in SCENES
      if name != 'damped')])
def test_the_edge_is_within_5_percent_of_the_closed_form(name, mode):
    """The limit is not where the springs blow up."""
    # Springs that come near their strain limit are taken implicitly, which does not blow up.
    found = run_edge({**SCENES[name], 'mode': mode, 'adaptive.threshold': 0.5}, probe='rest',
                     vary='scene', value=1.0)
    print(f'measured {found["ratio"]:.4f} of the closed form, '
          f'{found["measured"] / found["lattice"]:.4f} of that of this lattice')
    assert 0.95 < found['ratio'] < 1.05
    assert 0.98 < found['measured'] / found['lattice'] < 1.02


@pytest.mark.parametrize('shape', [(12, 1), (8, 8)])
def test_one_solve_constraint_stability_limit(shape):
    """With one solve, hard edges have the stability limit of their tensions."""
    rows, cols = shape
    found = run_edge(
        {'rows': rows, 'cols': cols, 'mode': 'constraint', 'constraint.newton_iterations': 1},
        probe='hanging', vary='scene', value=1.0)
    print(f'measured {found["ratio"]:.4f} of the closed form')
    assert 0.95 < found['ratio'] < 1.05


@pytest.mark.parametrize('mode', ['mass_spring', 'adaptive'])
@pytest.mark.parametrize(('share', 'outcome', 'refused'), [
    (0.9, 'stable', False), (1.1, 'unstable', True), (30.0, 'unstable', True)])
def test_points_are_told_apart(mode, share, outcome, refused):
    """A map would show stable what is not, or the other way round."""
    scene = {**SMALL, 'mode': mode}
    dt = share * stability_limit(Scene(scene))
    found = run_point(scene, factor=1.0, dt=dt, forced=True)
    assert (found['outcome'], found['refused']) == (outcome, refused)


def test_by_default_all_is_stable_or_refused():
    """Automatic substeps would let a cloth blow up."""
    for mode in ('mass_spring', 'adaptive', 'constraint'):
        for dt in (1e-2, 0.1):
            found = run_point({**SMALL, 'mode': mode}, factor=1e3, dt=dt, forced=False)
            assert found['outcome'] == 'stable'
    stiff = run_point(
        {**SMALL, 'mode': 'mass_spring', 'node_mass': 1e-6}, factor=1e5, dt=1.0, forced=False)
    assert stiff['outcome'] == 'refused' and 'set dt' in stiff['detail']


@pytest.fixture(scope='module')
def mapped(tmp_path_factory):
    """Make the runs of a map in two goes; return their number, what came out and the folder."""
    folder = tmp_path_factory.mktemp('map')
    runs = [run for run in map_points(SMALL, 2) if run.scene['mode'] == 'mass_spring']
    with ResultsFolder(folder) as results:
        make_runs(runs[:3], results, Workers(jobs=1), title='test')
    with ResultsFolder(folder) as results:
        found = make_runs(runs, results, Workers(jobs=1), title='test')
    return len(runs), found, folder


def test_a_study_goes_on_where_it_was(mapped):
    """Runs would be made again, or a map have holes."""
    count, found, folder = mapped
    assert all(result.is_done for result in found)
    assert len((folder / LINES).read_text().splitlines()) == len(found) == count


def test_tables_and_figures(mapped, tmp_path):
    """A study would end without its tables and figures."""
    _, points, _ = mapped
    found = [perform(run, False) for run in edges(SMALL)
             if run.settings['probe'] == 'rest' and run.settings['value'] == 8
             and run.scene['mode'] == 'mass_spring']
    assert all(result.is_done for result in points + found)
    # 4 points a map, of which half have the longest dt.
    assert '| mass_spring | one step a dt, at rest | 2 | 2 | 0 |' in map_table(points)
    row = edge_table(found).splitlines()[2]
    assert float(row.split('|')[-2]) == pytest.approx(1.0, abs=0.05)
    # No run of this map is refused for its number of substeps.
    assert [entry.get_label() for entry in map_legend(points)] == [
        'stable', 'unstable', 'refused unless one insists', 'closed form for one step a dt']
    draw_maps(points, tmp_path / 'maps.png')
    draw_edges(found, tmp_path / 'edges.png')
    assert min((tmp_path / name).stat().st_size for name in ('maps.png', 'edges.png')) > 10000


def test_all_that_is_asked_for_is_varied():
    """A property would be missing from the study."""
    varied = {run.settings['vary'].split(',')[0] for run in edges(SMALL)}
    assert {'nodes', 'stiffness', 'damping', 'mass', 'push', 'solves'} <= varied
    assert np.isfinite([run.settings['value'] for run in edges(SMALL)]).all()
