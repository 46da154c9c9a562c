# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The plots of a run or of several: figures over simulated time, and the strain of nodes."""

from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import dataclass
import math

from cloth_sim_ros.analysis.comparison import Comparison
from cloth_sim_ros.analysis.run import LARGEST
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.run import SUM
from cloth_sim_ros.analysis.summary import find_gaps
from matplotlib import color_sequences
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from matplotlib.ticker import NullFormatter
import numpy as np

WIDTH = 9.0           # [inch]
TITLE_HEIGHT = 1.0
PANEL_HEIGHT = 3.0
COLORS = ('#1f5fa8', '#d9831f', '#2f8f4e', '#303030')
INK = '#303030'
_PUSH = '#1560e0'
_SWITCH = '#8a2be2'
_GRID = '#dddddd'
_WIDE_RANGE = 20.0    # from the usual value, beyond which a scale is logarithmic
_MOST_NAMES = 12      # of modes, that still can be read


@dataclass(frozen=True)
class Line:
    """
    One column of a run as a line.

    :param scale: from the column's unit to the one shown
    :param above_zero: True when 0 says that there is no value
    """

    column: str
    label: str
    scale: float = 1.0
    above_zero: bool = False


@dataclass(frozen=True)
class Panel:
    """
    Lines with one axis.

    :param label: of the axis, with its unit
    :param scale: linear, log, or auto: log where the values range widely
    """

    label: str
    lines: Sequence[Line]
    scale: str = 'linear'


def time_plot(run: Run, title: str, panels: Sequence[Panel]) -> Figure:
    """Return a figure with ``panels`` below each other."""
    figure = Figure(
        figsize=(WIDTH, TITLE_HEIGHT + PANEL_HEIGHT * len(panels)), layout='constrained')
    all_axes = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    for axes, panel in zip(all_axes, panels):
        _draw(axes, run, panel)
        _mark(axes, run)
        finish_axes(axes, panel.label)
    _name_switches(all_axes[0], run)
    all_axes[-1].set_xlabel('simulated time [s]', color=INK)
    figure.suptitle(title, fontsize=11, color=INK)
    return figure


def finish_axes(axes: Axes, label: str) -> None:
    """Add the grid, the name of the axis and, where there is something to tell apart, names."""
    axes.set_ylabel(label, color=INK)
    axes.grid(color=_GRID, linewidth=0.6)
    axes.set_axisbelow(True)
    axes.margins(x=0.01)
    handles, names = axes.get_legend_handles_labels()
    if handles:
        axes.legend(
            handles, names, loc='upper left', bbox_to_anchor=(1.0, 1.0), frameon=False,
            fontsize=9)


def _draw(axes: Axes, run: Run, panel: Panel) -> None:
    shown = []
    for number, line in enumerate(panel.lines):
        if not run.has(line.column):
            continue
        values = line.scale * run.columns[line.column]
        if line.above_zero or panel.scale == 'log':
            values = np.where(values > 0.0, values, np.nan)
        shown.append(values)
        times, values = with_breaks(run, values)
        # A single line is named by its axis.
        label = line.label if len(panel.lines) > 1 else None
        axes.plot(times, values, color=COLORS[number], linewidth=1.3, label=label)
    if panel.scale == 'log' or panel.scale == 'auto' and _ranges_widely(shown):
        _set_log_scale(axes, np.concatenate(shown))
    elif all(np.nanmin(values) >= 0.0 for values in shown):
        axes.set_ylim(bottom=0.0)
        if all(np.nanmax(values % 1.0) == 0.0 for values in shown):
            axes.yaxis.set_major_locator(MaxNLocator(integer=True))


def _ranges_widely(shown: Sequence[np.ndarray]) -> bool:
    values = np.concatenate(shown)
    values = values[np.isfinite(values)]
    if not len(values) or values.min() <= 0.0:
        return False
    usual = np.median(values)
    return values.max() > _WIDE_RANGE * usual or usual > _WIDE_RANGE * values.min()


def _set_log_scale(axes: Axes, values: np.ndarray) -> None:
    """Show whole decades, in plain numbers."""
    axes.set_yscale('log')
    if np.isfinite(values).any():
        low, high = math.floor(_log10(np.nanmin(values))), math.ceil(_log10(np.nanmax(values)))
        axes.set_ylim(10.0**low, 10.0**max(high, low + 1))
    axes.yaxis.set_major_formatter(lambda value, _: f'{value:g}')
    axes.yaxis.set_minor_formatter(NullFormatter())


def _log10(value: float) -> float:
    return math.log10(value) if value > 0.0 else 0.0


def with_breaks(run: Run, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return times and values to draw: nothing is drawn across gaps and resets."""
    times, resets = run.columns['time'], run.columns['resets']
    # Moments that say nothing of this value are no gaps in it.
    told = np.isfinite(values)
    times, resets, values = times[told], resets[told], values[told]
    ends = {begin for begin, _ in find_gaps(times, resets)}
    after = [
        place + 1 for place in range(len(times) - 1)
        if times[place] in ends or resets[place + 1] != resets[place]]
    return np.insert(times, after, np.nan), np.insert(values, after, np.nan)


def _mark(axes: Axes, run: Run) -> None:
    begin, end = run.columns['time'][0], run.columns['time'][-1]
    label: str | None = 'push'
    for push in run.pushes:
        first, last = max(push.start, begin), min(push.end, end)
        if first < last:
            axes.axvspan(first, last, color=_PUSH, alpha=0.13, linewidth=0.0, label=label)
            label = None
    label = 'mode switch'
    for switch in run.modes.switches:
        axes.axvline(
            switch.time, color=_SWITCH, linewidth=1.1, linestyle=(0, (4, 3)), label=label)
        label = None


def _name_switches(axes: Axes, run: Run) -> None:
    switches = run.modes.switches
    for switch in switches if len(switches) <= _MOST_NAMES else ():
        axes.annotate(
            switch.mode, (switch.time, 1.0), xycoords=('data', 'axes fraction'),
            xytext=(0, 3), textcoords='offset points', fontsize=8, color=_SWITCH,
            rotation=20, ha='left', va='bottom')


# The strain of the nodes as a histogram.

BINS = 50
_HEIGHT = 4.5  # [inch]


def strain_histogram(run: Run) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return edges of bins of strain, and the shares of the nodes of all frames and the last."""
    strains = run.columns['max_strain']
    largest = float(strains[np.isfinite(strains)].max(initial=0.0))
    edges = np.linspace(0.0, (largest or 1e-6) * (1.0 + 1e-6), BINS + 1)
    return edges, *run.strains.shares(edges)


def strain_histogram_plot(run: Run, title: str) -> Figure:
    """Return the histogram as a figure."""
    edges, of_all, of_last = strain_histogram(run)
    figure = Figure(figsize=(WIDTH, _HEIGHT), layout='constrained')
    axes = figure.subplots()
    axes.stairs(
        of_all, 100.0 * edges, fill=True, color=COLORS[0], alpha=0.35,
        label=f'all {len(run.columns["time"])} frames')
    axes.stairs(
        of_last, 100.0 * edges, color=COLORS[1], linewidth=1.6,
        label=f'last frame, {run.columns["time"][-1]:.6g} s')
    # Few nodes have the most strain, and these matter.
    axes.set_yscale('log')
    axes.yaxis.set_major_formatter(lambda share, _: f'{100.0 * share:g} %')
    finish_axes(axes, f'fraction of the nodes in each of {BINS} bins')
    axes.set_xlabel('strain, largest of the springs at a node [%]', color=INK)
    figure.suptitle(title, fontsize=11, color=INK)
    return figure


# Which plots a run has, and what is in them.

_PLOTS = {
    'energies': ('Energies', (
        Panel('energy [J]', (
            Line('kinetic_energy', 'kinetic'), Line('elastic_energy', 'elastic'),
            Line('gravitational_energy', 'gravitational'), Line('total_energy', 'total'))),)),
    'strain': ('Strain |l / L0 - 1|', (
        Panel('strain [%]', (
            Line('max_strain', 'largest of all springs', 100.0),
            Line('mean_strain', 'mean of the nodes', 100.0))),)),
    'pin_forces': ('Forces of the cloth on its pins', (
        Panel('sum of all pins [N]', tuple(
            Line(name, axis) for name, axis in zip(SUM, 'xyz'))),
        Panel('largest of a pin [N]', (Line(LARGEST, 'largest'),)))),
    'constraints': ('Edges at their strain limit', (
        Panel('active constraints', (Line('active_constraints', 'active'),)),
        Panel('switches in the last step', (Line('constraint_switches', 'switches'),)))),
    'limits': ('How the strain limit was held', (
        Panel('substeps of the last step', (
            Line('calm_substeps', 'calm'), Line('listed_substeps', 'edges listed'),
            Line('whole_substeps', 'whole cloth'), Line('limit_unreached', 'not reached'))),
        Panel('edges listed in a substep', (Line('listed_edges', 'edges'),)),
        Panel('rounds of a substep', (Line('limit_rounds', 'rounds'),)),
        Panel('largest strain / limit', (Line('strain_over_bound', 'strain'),)))),
    'solver': ('Linear solver', (
        Panel('iterations, most of a solve', (Line('solver_iterations', 'iterations'),)),
        Panel('relative residual, worst solve', (Line('solver_residual', 'residual'),), 'log'))),
    'pace': ('Pace', (
        Panel('wall time of a step [ms]', (
            Line('step_wall_time', 'step of dt', 1e3, above_zero=True),), 'auto'),
        Panel('real-time factor', (
            Line('real_time_factor', 'simulated / wall', above_zero=True),), 'auto'))),
}
# Columns of which one is above 0 if a run has the feature.
_SIGNS = {
    'constraints': ('active_constraints',), 'solver': ('solver_iterations',),
    'limits': ('calm_substeps', 'listed_substeps', 'whole_substeps'),
    'pace': ('step_wall_time',)}


def run_plots(run: Run) -> Iterator[tuple[str, Figure]]:
    """Yield name and figure of each plot of what the run has."""
    for name, (title, panels) in _PLOTS.items():
        if all(any(run.has(line.column) for line in panel.lines) for panel in panels) and (
                _has_part(run, name)):
            shown = [panel for panel in panels if _has_values(run, panel)]
            yield name, time_plot(run, f'{title}: {_heading(run)}', shown)
    if run.has('mean_strain'):
        yield 'strain_histogram', strain_histogram_plot(
            run, f'Strain of the nodes: {_heading(run)}')


def _has_values(run: Run, panel: Panel) -> bool:
    # A node that only stepped while paused has no real-time factor.
    return any(
        run.has(line.column) and (not line.above_zero or (run.columns[line.column] > 0.0).any())
        for line in panel.lines)


def _has_part(run: Run, name: str) -> bool:
    if name == 'constraints' and 'adaptive' in run.modes.modes:
        return True
    return name not in _SIGNS or any((run.columns[sign] > 0.0).any() for sign in _SIGNS[name])


def _heading(run: Run) -> str:
    modes = ', '.join(run.modes.modes)
    size = f'{run.rows} x {run.cols} nodes' if run.rows else ''
    return ', '.join(filter(None, (run.name, size, modes)))


# Several runs in one figure.

_CURVE_PANELS = (
    ('max_strain', 'largest strain [%]', 100.0),
    ('mean_height', 'mean height [m]', 1.0),
    ('total_energy', 'total energy [J]', 1.0),
    (LARGEST, 'largest force of a pin [N]', 1.0))
_DISTANCE_PANELS = (
    ('rms_distance', 'RMS node distance [m]', 1.0),
    ('strain_difference', 'difference of max strain [%]', 100.0),
    ('energy_difference', 'difference of total energy [J]', 1.0))


def overlay_plot(runs: Sequence[Run], names: Sequence[str]) -> Figure:
    """
    Return a figure of what any of ``runs`` has, over simulated time.

    :param names: of the runs, for the legend
    """
    panels = [panel for panel in _CURVE_PANELS if any(run.has(panel[0]) for run in runs)]
    figure = Figure(
        figsize=(WIDTH, TITLE_HEIGHT + PANEL_HEIGHT * len(panels)), layout='constrained')
    all_axes = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    colors = color_sequences['tab10']
    for axes, (column, label, scale) in zip(all_axes, panels):
        for number, (run, name) in enumerate(zip(runs, names)):
            if run.has(column):
                times, values = with_breaks(run, scale * run.columns[column])
                axes.plot(
                    times, values, linewidth=1.3, color=colors[number % len(colors)], label=name)
        finish_axes(axes, label)
    all_axes[-1].set_xlabel('simulated time [s]', color=INK)
    figure.suptitle(', '.join(names), fontsize=11, color=INK)
    return figure


def comparison_plot(comparisons: Sequence[Comparison]) -> Figure:
    """Return a figure with a panel for each quantity and a line for each comparison."""
    panels = [
        panel for panel in _DISTANCE_PANELS
        if any(np.isfinite(getattr(each, panel[0])).any() for each in comparisons)]
    figure = Figure(
        figsize=(WIDTH, TITLE_HEIGHT + PANEL_HEIGHT * len(panels)), layout='constrained')
    all_axes = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    colors = color_sequences['tab10']
    for axes, (name, label, scale) in zip(all_axes, panels):
        for number, each in enumerate(comparisons):
            axes.plot(
                each.times, scale * getattr(each, name), linewidth=1.3,
                color=colors[number % len(colors)], label=each.second)
        finish_axes(axes, label)
    all_axes[-1].set_xlabel('simulated time [s]', color=INK)
    figure.suptitle(f'Against {comparisons[0].first}', fontsize=11, color=INK)
    return figure
