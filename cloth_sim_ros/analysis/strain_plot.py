# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The strain of the nodes as a histogram."""

from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.time_plot import COLORS
from cloth_sim_ros.analysis.time_plot import finish_axes
from cloth_sim_ros.analysis.time_plot import INK
from cloth_sim_ros.analysis.time_plot import WIDTH
from matplotlib.figure import Figure
import numpy as np

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
