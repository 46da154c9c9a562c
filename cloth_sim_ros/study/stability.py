# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
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
from pathlib import Path

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.scene_values import given_values
from cloth_sim_ros.study.stable.plan import edges
from cloth_sim_ros.study.stable.plan import map_points
from cloth_sim_ros.study.stable.report import edge_table
from cloth_sim_ros.study.stable.report import map_table
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import workers_of

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
    from cloth_sim_ros.study.stable.figures import draw_edges
    from cloth_sim_ros.study.stable.figures import draw_maps
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
