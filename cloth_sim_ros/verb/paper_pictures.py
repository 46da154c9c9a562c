# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Reproduce Fig. 10 or 11 of the paper: recordings, a table of peak values, and a sheet of images.

Each run of a figure is recorded in the folder of that figure. Some runs are unstable, as in the
paper; they stop at their last finite state. docs/notes/paper.md discusses the results.

For example:
  cloth_sim paper fig10 --sheet fig10.png
  cloth_sim paper fig11 --out bags/fig11 --set rows=20 --set cols=20
"""

from argparse import ArgumentParser
from argparse import Namespace
from pathlib import Path
import sys

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.summary import outcome_table
from cloth_sim_ros.analysis.summary import RunOutcome
from cloth_sim_ros.api.scene_file import scene_from
from cloth_sim_ros.rendering.picture import write_run_sheet
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.paper_figures import FIGURES
from cloth_sim_ros.study.paper_figures import paper_scene_file
from cloth_sim_ros.study.paper_figures import PaperFigure
from cloth_sim_ros.verb.batch_run import record_run
from cloth_sim_ros.verb.recording_arguments import list_of_times
from cloth_sim_ros.verb.scene_arguments import parse_change

_SECONDS = 3.0


def add_arguments(parser: ArgumentParser, figure: str) -> None:
    """Add the arguments of ``figure``."""
    parser.add_argument('--out', metavar='DIR',
                        help=f'folder of the recordings (default: bags/paper_{figure})')
    parser.add_argument('--sheet', metavar='FILE.png',
                        help=f'image to write (default: {figure}.png in that folder)')
    parser.add_argument('--seconds', type=float, default=_SECONDS, metavar='T',
                        help='simulated time of each run (default: %(default)s)')
    parser.add_argument('--at', type=list_of_times, metavar='T,T,...',
                        help='times to show [s]')
    parser.add_argument('--set', action='append', default=[], metavar='name=value', dest='changes',
                        help='set a parameter of all runs; can be given several times')


def main(args: Namespace) -> int:
    """Run, print the table, and draw."""
    figure = FIGURES[args.figure]
    folder = Path(args.out or f'bags/paper_{args.figure}')
    _refuse_to_overwrite(folder, figure)
    changes = dict(map(parse_change, args.changes))
    rows, shown = [], []
    for run in figure.runs:
        scene, node_values = scene_from(paper_scene_file(), {**changes, **run.changes})
        print(run.label, file=sys.stderr)
        problem = record_run(
            scene, node_values, args.seconds, folder, run.name,
            check_stability=run.check_stability)
        if problem:
            print(f'{run.label}: {problem}')
        recording = Recording(folder / run.name)
        outcome = RunOutcome.of(Run(recording))
        rows.append((run.label, outcome, allowed_strain(scene)))
        shown.append((run.label, recording, outcome))
    print(outcome_table(rows))
    sheet = args.sheet or folder / f'{args.figure}.png'
    times = [time for time in args.at or figure.times if time <= args.seconds]
    write_run_sheet(sheet, shown, times or [args.seconds], figure.title)
    print(sheet)
    return 0


def _refuse_to_overwrite(folder: Path, figure: PaperFigure) -> None:
    for run in figure.runs:
        if (folder / run.name).exists():
            raise ClothSimError(
                f'{folder / run.name} already exists, and no recording is overwritten: name '
                'another folder with --out')


def allowed_strain(scene: Scene) -> float | None:
    """Return the strain up to which the mode of ``scene`` lets edges be; None for any."""
    return {'hard': 0.0, 'limited': scene['adaptive.threshold']}.get(
        AVAILABLE[scene['mode']].edge_model(scene))
