# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Map the stable region of a scene over dt and stiffness, and compare its limits with closed forms.

The maps show, for each mode, the cloth at rest with one substep per dt regardless of the stability
limit, and the moving scene with automatic substeps. Bisection then finds the limits over
resolution, stiffness, damping, mass, pushes and number of solves. docs/notes/stability.md defines
instability.

For example:
  cloth_sim study stability config/drape.yaml --set rows=24 --set cols=24
  cloth_sim study stability config/drape.yaml --cells 13 --jobs 2 --out studies/stability
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.scene_values import given_values
from cloth_sim_ros.study.scene_values import scaled_damping
from cloth_sim_ros.study.stability_runs import edge_table
from cloth_sim_ros.study.stability_runs import map_table
from cloth_sim_ros.study.stability_runs import with_stiffness
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of
import numpy as np

_RUNS = 'cloth_sim_ros.study.stability_runs'
_POINT, _EDGE = f'{_RUNS}:run_point', f'{_RUNS}:run_edge'
_GRAVITY = 9.81
STIFFNESS_FACTORS = (1e-2, 1e3)
DTS = (1e-5, 1e-1)
SIZES = {'rest': (8, 16, 32, 64), 'hanging': (8, 16, 32)}
DAMPING_FACTORS = (0.0, 1.0, 10.0, 100.0)
MASS_FACTORS = (1e-2, 1.0, 1e2)
# Forces of the push [weights of the cloth]; it acts from 0.05 to 0.15 s.
PUSHES = (0.0, 1.0, 5.0, 20.0)
_PUSH_START, _PUSH_SECONDS = 0.05, 0.1


def map_points(values: Mapping[str, Any], cells: int) -> list[Run]:
    """
    Return the points of the maps, dt over stiffness, of each mode.

    :param cells: along each axis
    """
    factors = np.geomspace(*STIFFNESS_FACTORS, cells)
    dts = np.geomspace(*DTS, cells)
    return [
        Run(_POINT, {**values, 'mode': mode},
            {'factor': float(f'{factor:.6g}'), 'dt': float(f'{dt:.6g}'), 'forced': forced})
        for mode in MODES for forced in (True, False) for factor in factors for dt in dts]


def edges(values: Mapping[str, Any]) -> list[Run]:
    """Return the edges to be found: each varies one property of the scene."""
    runs = []

    def add(probe: str, mode: str, vary: str, value: float, changed: Mapping[str, Any]) -> None:
        runs.append(Run(
            _EDGE, {**changed, 'mode': mode}, {'probe': probe, 'vary': vary, 'value': value}))

    for size in SIZES['rest']:
        add('rest', 'mass_spring', 'nodes', size, _of_size(values, size))
    for factor in (1e-2, 1.0, 1e2):
        add('rest', 'mass_spring', 'stiffness', factor, with_stiffness(values, factor))
    for factor in DAMPING_FACTORS:
        add('rest', 'mass_spring', 'damping', factor, _damped(values, factor))
    for factor in MASS_FACTORS:
        add('rest', 'mass_spring', 'mass', factor, _heavier(values, factor))
    for factor in DAMPING_FACTORS[:2]:
        add('rest', 'adaptive', 'damping', factor, _damped(values, factor))
    for push in PUSHES:
        add('moving', 'mass_spring', 'push', push, _pushed(values, push))
        add('moving', 'mass_spring', 'push, undamped', push, _damped(_pushed(values, push), 0.0))
    one_solve = {**values, 'constraint.newton_iterations': 1}
    for size in SIZES['hanging']:
        add('hanging', 'constraint', 'nodes, one solve', size, _of_size(one_solve, size))
    add('hanging', 'constraint', 'nodes, one solve, no shear', SIZES['hanging'][-1], {
        **_of_size(one_solve, SIZES['hanging'][-1]), 'constraint.hard': ['structural']})
    for factor in (1e-2, 1e2):
        add('hanging', 'constraint', 'mass, one solve', factor, _heavier(
            _of_size(one_solve, SIZES['hanging'][1]), factor))
    for solves in (1, 2, 3):
        add('hanging', 'constraint', 'solves', solves, {
            **_of_size(values, SIZES['hanging'][1]), 'constraint.newton_iterations': solves})
    return runs


def _of_size(values: Mapping[str, Any], size: int) -> dict[str, Any]:
    """Return the same cloth with ``size`` nodes along its longer side."""
    scene = Scene(values)
    most = max(scene.rows, scene.cols)
    # Pins and moves name nodes that a cloth of another size may not have.
    return {
        **{name: value for name, value in values.items() if not name.startswith('pin_moves.')},
        'pins': ['top_edge'], 'rows': max(1, round(scene.rows * size / most)),
        'cols': max(1, round(scene.cols * size / most))}


def _damped(values: Mapping[str, Any], factor: float) -> dict[str, Any]:
    return {**values, **scaled_damping(Scene(values), factor)}


def _heavier(values: Mapping[str, Any], factor: float) -> dict[str, Any]:
    scene = Scene(values)
    if scene['node_mass']:
        return {**values, 'node_mass': factor * scene.node_mass}
    return {**values, 'areal_density': 0.0, 'total_mass': factor * scene.mass}


def _pushed(values: Mapping[str, Any], push: float) -> dict[str, Any]:
    """Return the scene with one upward push [weights of the cloth] instead of its own pushes."""
    scene = Scene(values)
    weight = _GRAVITY * scene.node_mass * float(scene.node_shares[~scene.pinned_nodes()].sum())
    alone = {name: value for name, value in values.items() if not name.startswith('pushes.')}
    return alone if not push else {
        **alone, 'pushes.start': [_PUSH_START], 'pushes.duration': [_PUSH_SECONDS],
        'pushes.force': [0.0, 0.0, push * weight]}


TAKES_SCENE = True


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--cells', type=int, default=9, metavar='N',
                        help='points along each axis of a map; 0 for no maps '
                             '(default: %(default)s)')
    parser.add_argument('--figure', action='append', default=[], metavar='FILE.png', type=Path,
                        dest='figures', help='figure of the maps to write and, given a second '
                        'time, of the limits (default: maps.png and edges.png in --out)')
    add_run_arguments(parser, 'studies/stability')


def main(args: Namespace) -> int:
    """Make the runs, and write tables and figures."""
    if len(args.figures) > 2:
        raise ClothSimError(
            f'--figure was given {len(args.figures)} times and there are 2 figures: leave some '
            'out')
    if args.cells != 0 and args.cells < 2:
        raise ClothSimError(f'--cells must be 2 or more, or 0 for no maps, got {args.cells}')
    values = given_values(args.scene)
    folder = Path(args.out)
    points = map_points(values, args.cells) if args.cells else []
    with ResultsFolder(folder) as results:
        workers = workers_of(args)
        found = make_runs(edges(values), results, workers, title='edges')
        mapped = make_runs(points, results, workers, title='maps')
    text = edge_table(found) + ('\n' + map_table(mapped) if mapped else '')
    (folder / 'stability.md').write_text(text, encoding='utf-8')
    # Matplotlib is slow to import.
    from cloth_sim_ros.study.stability_figures import draw_edges
    from cloth_sim_ros.study.stability_figures import draw_maps
    named = [Path(figure) for figure in args.figures]
    named += [folder / name for name in ('maps.png', 'edges.png')[len(named):]]
    maps, edge_figure = named
    draw_edges(found, edge_figure)
    if mapped:
        draw_maps(mapped, maps)
    print(text)
    print(f'tables are in {folder / "stability.md"}, figures in {edge_figure}'
          + (f' and {maps}' if mapped else ''))
    return 0
