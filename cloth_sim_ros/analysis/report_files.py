# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Analyses as files: CSV, JSON and PNG."""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
import csv
from dataclasses import asdict
import json
import math
import os
from pathlib import Path
from typing import Any
from typing import cast

from cloth_sim_ros.analysis.comparison import Comparison
from cloth_sim_ros.analysis.plots import strain_histogram
from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.summary import Summary
from cloth_sim_ros.sim.errors import ClothSimError
from matplotlib import rc_context
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
import numpy as np

_DOTS_PER_INCH = 110
# In one piece, the outline of a line of ten minutes takes up to 40 MiB.
_POINTS_AT_ONCE = 2000
_WHOLE = {
    'resets', 'substeps', 'solver_iterations', 'solver_reached', 'active_constraints',
    'constraint_switches', 'calm_substeps', 'listed_substeps', 'whole_substeps', 'listed_edges',
    'limit_rounds', 'limit_unreached', 'lengths_are_held', 'settling', 'stalled_pins',
    'self_contacts', 'cut_nodes', 'halved_substeps', 'surface_contact_held'}
_COMPARED = (
    'times', 'rms_distance', 'max_distance', 'strain_difference', 'energy_difference')


def make_folder(path: str | os.PathLike[str]) -> Path:
    """Return the folder ``path``, made if it is not there; ClothSimError when that can't be."""
    folder = Path(path)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise _no_file(folder, error) from error
    return folder


def write_frames(run: Run, path: Path) -> None:
    """Write a row for each frame; a cell is empty where the recording says nothing."""
    names = [name for name in run.columns if run.has(name)]
    cells = [_cells(name, run.columns[name]) for name in names]
    modes = (run.modes.at(time) for time in run.columns['time'])
    write_csv(path, [*names, 'mode'], zip(*cells, modes))


def write_comparison(comparison: Comparison, path: Path) -> None:
    """Write a row for each time that both recordings have a frame at."""
    cells = [_cells(name, getattr(comparison, name)) for name in _COMPARED]
    write_csv(path, ['time', *_COMPARED[1:]], zip(*cells))


def summary_values(summary: Summary, run: Run) -> dict[str, Any]:
    """Return all of ``summary``, with times and strain histogram, as JSON takes it."""
    values = asdict(summary)
    values['pushes_given'] = [
        {**asdict(push), 'end': push.end} for push in run.pushes]
    if run.has('mean_strain'):
        edges, of_all, of_last = strain_histogram(run)
        values['strain_histogram'] = {
            'edges': edges.tolist(), 'all_frames': of_all.tolist(),
            'last_frame': of_last.tolist()}
    return values


def comparison_values(comparison: Comparison) -> dict[str, Any]:
    """Return ``comparison`` in numbers; the series are in its CSV file."""
    values = {
        'first': comparison.first, 'second': comparison.second,
        'matched_frames': len(comparison.times), 'unmatched_frames': comparison.unmatched,
        'begin': comparison.times[0], 'end': comparison.times[-1],
        'identical': comparison.identical}
    for name in _COMPARED[1:]:
        series = getattr(comparison, name)
        told = series[np.isfinite(series)]
        values[f'{name}_at_end'] = told[-1] if len(told) else math.nan
        values[f'{name}_at_most'] = (
            told[np.argmax(np.abs(told))] if len(told) else math.nan)
    return values


def write_points(recording: Recording, path: Path) -> None:
    """Write the arrays of ~/points, all frames, as an npz file; ClothSimError without points."""
    arrays = recording.arrays('points')
    try:
        with open(path, 'wb') as file:
            # Its types take any name for that of an option.
            np.savez(file, **cast(dict[str, Any], arrays))
    except OSError as error:
        raise _no_file(path, error) from error


def write_json(values: Any, path: Path) -> None:
    """Write ``values`` as JSON; what is not finite becomes null, as JSON has no other way."""
    text = json.dumps(_plain(values), indent=2, allow_nan=False) + '\n'
    try:
        path.write_text(text, encoding='utf-8')
    except OSError as error:
        raise _no_file(path, error) from error


def write_csv(path: Path, names: Sequence[str], rows: Any) -> None:
    """Write a table with a header."""
    try:
        with open(path, 'w', newline='', encoding='utf-8') as file:
            writer = csv.writer(file)
            writer.writerow(names)
            writer.writerows(rows)
    except OSError as error:
        raise _no_file(path, error) from error


def write_plot(figure: Figure, path: Path) -> None:
    """Write ``figure`` as a PNG file."""
    try:
        with rc_context({'agg.path.chunksize': _POINTS_AT_ONCE}):
            FigureCanvasAgg(figure).print_figure(path, dpi=_DOTS_PER_INCH, format='png')
    except OSError as error:
        raise _no_file(path, error) from error


def _cells(name: str, values: np.ndarray) -> Iterator[str]:
    # One at a time: as text, a long run takes ten times the room of its numbers.
    form = '.0f' if name in _WHOLE else '.9g'
    for value in values:
        yield f'{value:{form}}' if math.isfinite(value) else ''


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {name: _plain(part) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(part) for part in value]
    if isinstance(value, (float, np.floating)):
        return float(value) if math.isfinite(value) else None
    return value


def _no_file(path: Path, error: OSError) -> ClothSimError:
    return ClothSimError(f'{path} cannot be written ({error.strerror}): give another --out')
