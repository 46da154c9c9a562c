# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""How far recordings are from the first one, over simulated time."""

from collections.abc import Sequence

from cloth_sim_ros.analysis.comparison import Comparison
from cloth_sim_ros.analysis.time_plot import finish_axes
from cloth_sim_ros.analysis.time_plot import INK
from cloth_sim_ros.analysis.time_plot import PANEL_HEIGHT
from cloth_sim_ros.analysis.time_plot import TITLE_HEIGHT
from cloth_sim_ros.analysis.time_plot import WIDTH
from matplotlib import colormaps
from matplotlib.figure import Figure
import numpy as np

_PANELS = (
    ('rms_distance', 'RMS node distance [m]', 1.0),
    ('strain_difference', 'difference of max strain [%]', 100.0),
    ('energy_difference', 'difference of total energy [J]', 1.0))


def comparison_plot(comparisons: Sequence[Comparison]) -> Figure:
    """Return a figure with a panel for each quantity and a line for each comparison."""
    panels = [
        panel for panel in _PANELS
        if any(np.isfinite(getattr(each, panel[0])).any() for each in comparisons)]
    figure = Figure(
        figsize=(WIDTH, TITLE_HEIGHT + PANEL_HEIGHT * len(panels)), layout='constrained')
    all_axes = np.atleast_1d(figure.subplots(len(panels), 1, sharex=True))
    colors = colormaps['tab10'].colors
    for axes, (name, label, scale) in zip(all_axes, panels):
        for number, each in enumerate(comparisons):
            axes.plot(
                each.times, scale * getattr(each, name), linewidth=1.3,
                color=colors[number % len(colors)], label=each.second)
        finish_axes(axes, label)
    all_axes[-1].set_xlabel('simulated time [s]', color=INK)
    figure.suptitle(f'Against {comparisons[0].first}', fontsize=11, color=INK)
    return figure
