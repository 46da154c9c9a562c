# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""
Analyse recordings: print a table and, with --out, write CSV, JSON and plots.

Reads mcap and sqlite3 bags of this project and of ros2 bag record, even truncated ones. If several
bags are given, each is compared with the first at the simulated times at which both have a frame,
and --out also gets a plot of all their curves. Needs no node.

For example:
  cloth_sim analyze bags/cloth_2026_01_31-12_00_00
  cloth_sim analyze bags/drop_springs bags/drop_constraint --out drop
  cloth_sim analyze bags/drop_springs --out drop --npz
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cloth_sim_ros.analysis.comparison import compare
from cloth_sim_ros.analysis.comparison import Comparison
from cloth_sim_ros.analysis.comparison import comparison_lines
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.report_files import comparison_values
from cloth_sim_ros.analysis.report_files import make_folder
from cloth_sim_ros.analysis.report_files import summary_values
from cloth_sim_ros.analysis.report_files import write_comparison
from cloth_sim_ros.analysis.report_files import write_frames
from cloth_sim_ros.analysis.report_files import write_json
from cloth_sim_ros.analysis.report_files import write_plot
from cloth_sim_ros.analysis.report_files import write_points
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.summary import Summary
from cloth_sim_ros.analysis.summary import summary_lines
from cloth_sim_ros.analysis.summary import text_table
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.verb.progress import ReadingProgress
from cloth_sim_ros.verb.recording_arguments import add_node_argument


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this verb."""
    parser.add_argument(
        'recordings', nargs='+', metavar='BAG',
        help='folder of a recording of this project or of ros2 bag, or its mcap or db3 file')
    add_node_argument(parser)
    parser.add_argument(
        '--out', metavar='DIR',
        help='directory for CSV, JSON and plots, in one folder per recording')
    parser.add_argument(
        '--npz', action='store_true',
        help='with --out, also write points.npz: time, positions, velocities, normals, strain '
             'and flags of all frames')


def main(args: Namespace) -> int:
    """Analyse one by one, then compare."""
    if args.npz and not args.out:
        raise ClothSimError('--npz needs a folder for its files: give --out')
    recordings = [Recording(path, args.node) for path in args.recordings]
    names = _names(recordings)
    # Told before minutes of reading, not after.
    folder = make_folder(args.out) if args.out else None
    runs = []
    for recording, name in zip(recordings, names):
        run = Run(recording, ReadingProgress(name))
        summary = Summary.of(run)
        print(f'{recording.path}\n{text_table(summary_lines(summary))}\n')
        if folder:
            _write_run(run, summary, make_folder(folder / name))
            if args.npz:
                write_points(recording, folder / name / 'points.npz')
        runs.append(run)
    comparisons = [
        replace(
            compare(recordings[0], other, ReadingProgress(f'{name} against {names[0]}')),
            first=names[0], second=name)
        for other, name in zip(recordings[1:], names[1:])]
    for comparison in comparisons:
        print(f'{text_table(comparison_lines(comparison))}\n')
    if folder:
        if comparisons:
            _write_comparisons(comparisons, names, folder)
            _write_curves(runs, names, folder)
        print(folder)
    return 0


def _write_run(run: Run, summary: Summary, folder: Path) -> None:
    # Drawing takes a second to load, and a table alone does not need it.
    from cloth_sim_ros.analysis.plots import run_plots
    write_frames(run, folder / 'frames.csv')
    write_json(summary_values(summary, run), folder / 'summary.json')
    for name, figure in run_plots(run):
        write_plot(figure, folder / f'{name}.png')


def _write_comparisons(
        comparisons: Sequence[Comparison], names: Sequence[str], folder: Path) -> None:
    from cloth_sim_ros.analysis.plots import comparison_plot
    for comparison, name in zip(comparisons, names[1:]):
        write_comparison(comparison, folder / f'{name}_against_{names[0]}.csv')
    write_json([comparison_values(each) for each in comparisons], folder / 'comparison.json')
    write_plot(comparison_plot(comparisons), folder / 'comparison.png')


def _write_curves(runs: Sequence[Run], names: Sequence[str], folder: Path) -> None:
    from cloth_sim_ros.analysis.plots import overlay_plot
    write_plot(overlay_plot(runs, names), folder / 'curves.png')


def _names(recordings: Sequence[Recording]) -> list[str]:
    """Return a name for each recording that no other one has."""
    names: list[str] = []
    for recording in recordings:
        others = names.count(recording.name)
        names.append(f'{recording.name}_{others + 1}' if others else recording.name)
    return names
