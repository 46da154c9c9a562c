# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Error against cost, drawn: a panel for each variant of the scene."""

from collections.abc import Iterable
from pathlib import Path

from cloth_sim_ros.study.trade.front import front
from cloth_sim_ros.study.trade.front import Row
from cloth_sim_ros.study.trade.grid import Variant
from cloth_sim_ros.study.trade.measured import Measured
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
import numpy as np

_COLOURS = ('#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9')
_COLUMNS = 2
_DPI = 110


def write_plot(path: Path, measured: Measured) -> None:
    """Write the figure as PNG."""
    variants = [v for v in measured.grid.variants if _drawable(measured.rows_of(v), v)]
    lines = -(-len(variants) // _COLUMNS)
    figure = Figure(figsize=(7.6 * _COLUMNS, 4.4 * lines), layout='constrained')
    panels = figure.subplots(lines, min(_COLUMNS, len(variants)), squeeze=False).flatten()
    for panel in panels[len(variants):]:
        panel.set_visible(False)
    methods = list(dict.fromkeys(row.setting.method for row in measured.rows))
    colours = {method: _COLOURS[i % len(_COLOURS)] for i, method in enumerate(methods)}
    for panel, variant in zip(panels, variants):
        _draw(panel, measured, variant, colours)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc='outside lower center', ncols=len(labels))
    figure.savefig(path, dpi=_DPI)


def _drawable(rows: list[Row], variant: Variant) -> list[Row]:
    return [row for row in rows if row.is_useful(variant.is_scene)]


def _draw(
        panel: Axes, measured: Measured, variant: Variant, colours: dict[str, str]) -> None:
    rows = _drawable(measured.rows_of(variant), variant)
    for method, colour in colours.items():
        for is_timed in (True, False):
            points = [row for row in rows
                      if row.setting.method == method and bool(row.rounds) == is_timed]
            panel.scatter(
                [row.cost for row in points], _errors(points, variant),
                s=26, color=colour, facecolors=colour if is_timed else 'none',
                label=method if is_timed else None, zorder=3)
    best = front(rows, of_scene=variant.is_scene)
    panel.plot(
        [row.cost for row in best], _errors(best, variant),
        color='0.4', linewidth=1.0, label='Pareto front')
    for number, row in enumerate(best, 1):
        panel.annotate(
            str(number), (row.cost, row.known_error(variant.is_scene)), fontsize=8,
            xytext=(3, 4), textcoords='offset points')
    # Beside the panel: names of similar settings would overlap along the front.
    panel.text(
        1.02, 1.0, '\n'.join(
            f'{number}  {row.setting.method}, {row.setting.label}'
            for number, row in enumerate(best, 1)),
        transform=panel.transAxes, fontsize=7, verticalalignment='top')
    panel.scatter([], [], s=26, color='0.4', facecolors='none', label='not timed: an estimate')
    panel.axvline(1.0, color='0.7', linewidth=1.0, linestyle='--', label='real time')
    panel.set(xscale='log', yscale='log', xlabel='time of a simulated second [s]')
    own = 'position error / side'
    # Labels of all minor ticks run into one another.
    panel.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    panel.xaxis.set_major_formatter('{x:g}')
    panel.xaxis.set_minor_formatter('')
    panel.set_ylabel(own if variant.is_scene else f'{own}, against its own model')
    first = rows[0].run.scene
    panel.set_title(
        f'{variant.name}: {first.get("rows", 32)} x {first.get("cols", 32)} nodes', fontsize=10)
    panel.grid(True, which='major', color='0.9')
    panel.margins(x=0.22, y=0.12)


def _errors(rows: Iterable[Row], variant: Variant) -> np.ndarray:
    """Return the error of each row; NaN, which is not drawn, where there is none."""
    return np.array([row.error(variant.is_scene) for row in rows], float)
