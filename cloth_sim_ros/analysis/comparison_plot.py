# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Several runs in one figure."""

from collections.abc import Sequence

from cloth_sim_ros.analysis.comparison import Comparison
from cloth_sim_ros.analysis.pin_columns import LARGEST
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.time_plot import finish_axes
from cloth_sim_ros.analysis.time_plot import INK
from cloth_sim_ros.analysis.time_plot import PANEL_HEIGHT
from cloth_sim_ros.analysis.time_plot import TITLE_HEIGHT
from cloth_sim_ros.analysis.time_plot import WIDTH
from cloth_sim_ros.analysis.time_plot import with_breaks
from matplotlib import color_sequences
from matplotlib.figure import Figure
import numpy as np

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
