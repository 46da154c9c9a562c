# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The figures of the stability study: maps with the closed form over them, and edges."""

from collections.abc import Mapping
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.stability_probes import REFUSED
from cloth_sim_ros.study.stability_probes import STABLE
from cloth_sim_ros.study.stability_probes import UNSTABLE
from cloth_sim_ros.study.stability_runs import points_of
from cloth_sim_ros.study.stability_runs import predicted_limit
from cloth_sim_ros.study.stability_runs import steps_of
from cloth_sim_ros.study.stability_runs import with_stiffness
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
import numpy as np

# Told apart without colour vision, too: light, dark, grey.
_COLORS = {STABLE: '#a8d5c2', UNSTABLE: '#b5402f', REFUSED: '#c9c9c9'}
_OUTCOMES = tuple(_COLORS)
_OUTCOME_LABELS = {
    STABLE: 'stable', UNSTABLE: 'unstable', REFUSED: 'refused: too many substeps'}
_INK = '#202020'
_DPI = 110
_LINE_POINTS = 30
_EDGE_PANELS = {
    ('rest', 'nodes'): 'nodes along the side',
    ('rest', 'stiffness'): 'stiffness, over that of the scene',
    ('rest', 'damping'): 'damping, over that of the scene',
    ('rest', 'mass'): 'mass, over that of the scene',
    ('moving', 'push, undamped'): 'push, over the weight; no damping',
    ('hanging', 'nodes, one solve'): 'nodes along the side, mode constraint',
}


def draw_maps(results: Sequence[Result], path: Path) -> None:
    """Draw dt over stiffness for each mode, forced above, by default below, into a PNG file."""
    figure = Figure(figsize=(11.0, 7.4), layout='constrained')
    panels = figure.subplots(2, len(MODES), sharex=True, sharey=True)
    for row, forced in enumerate((True, False)):
        for axes, mode in zip(panels[row], MODES):
            _draw_map(axes, points_of(results, mode, forced))
            axes.set_title(f'{mode}, {steps_of(mode, forced)}', fontsize=10)
    for axes in panels[1]:
        axes.set_xlabel(f'stiffness of {_widest(results)} springs [N/m]')
    for axes in panels[:, 0]:
        axes.set_ylabel('dt [s]')
    handles = map_legend(results)
    figure.legend(
        handles=handles, loc='outside lower center', ncols=len(handles), frameon=False)
    figure.savefig(path, dpi=_DPI)


def map_legend(results: Sequence[Result]) -> list[Artist]:
    """Return an entry for each kind of cell and mark that the maps of ``results`` have."""
    values = [result.values for result in results if result.is_done]
    outcomes = {value['outcome'] for value in values}
    handles: list[Artist] = [
        Patch(facecolor=color, label=_OUTCOME_LABELS[outcome])
        for outcome, color in _COLORS.items() if outcome in outcomes]
    if any(value['refused'] and value['outcome'] != REFUSED for value in values):
        handles.append(Line2D(
            [], [], color=_INK, marker='x', linestyle='none', label='refused unless one insists'))
    return [*handles, Line2D([], [], color='k', label='closed form for one step a dt')]


def draw_edges(results: Sequence[Result], path: Path) -> None:
    """Draw measured edges on the line of the closed form into a PNG file."""
    figure = Figure(figsize=(11.0, 6.6), layout='constrained')
    for axes, (key, label) in zip(figure.subplots(2, 3).flat, _EDGE_PANELS.items()):
        rows = [result for result in results if result.is_done and result.values['measured']
                and (result.settings['probe'], result.settings['vary']) == key
                and result.scene['mode'] != 'adaptive']
        _draw_edge(axes, rows, label)
    figure.legend(
        handles=[
            Line2D([], [], color='k', label='closed form'),
            Line2D([], [], color='k', linestyle='--', label='closed form for any shape'),
            Line2D([], [], color=_COLORS[UNSTABLE], marker='o', linestyle='none',
                   label='measured edge')],
        loc='outside lower center', ncols=3, frameon=False)
    figure.savefig(path, dpi=_DPI)


def _draw_map(axes: Axes, results: Sequence[Result]) -> None:
    if not results:
        return
    factors = sorted({result.settings['factor'] for result in results})
    dts = sorted({result.settings['dt'] for result in results})
    grid = np.full((len(dts), len(factors)), np.nan)
    scene = results[0].scene
    scale = Scene(scene).stiffness(_widest(results))
    for result in results:
        row, col = dts.index(result.settings['dt']), factors.index(result.settings['factor'])
        if not result.is_done:
            continue
        grid[row, col] = _OUTCOMES.index(result.values['outcome'])
        if result.values['refused'] and result.values['outcome'] != REFUSED:
            axes.plot(scale * factors[col], dts[row], 'x', color=_INK, markersize=4)
    axes.pcolormesh(
        _borders(scale * np.array(factors)), _borders(np.array(dts)), grid,
        cmap=ListedColormap(list(_COLORS.values())), vmin=-0.5, vmax=len(_COLORS) - 0.5,
        edgecolors='white', linewidth=0.4)
    _draw_line(axes, scene, factors, scale)
    axes.set(xscale='log', yscale='log')
    lowest, *_, highest = _borders(np.array(dts))
    axes.set_ylim(lowest, highest)


def _draw_line(
        axes: Axes, scene: Mapping[str, Any], factors: Sequence[float], scale: float) -> None:
    least, *_, most = _borders(np.array(factors))
    stiffness = np.geomspace(least, most, _LINE_POINTS)
    mode = scene['mode']
    if AVAILABLE[mode].is_implicit:
        # The limit of hard edges does not depend on a stiffness.
        limits = np.full(_LINE_POINTS, predicted_limit(scene, mode))
    else:
        limits = np.array([
            predicted_limit(with_stiffness(scene, factor), mode) for factor in stiffness])
    axes.plot(scale * stiffness, limits, color='k', linewidth=1.6)


def _draw_edge(axes: Axes, results: Sequence[Result], label: str) -> None:
    axes.set_xlabel(label)
    axes.set_ylabel('longest stable dt [s]')
    if not results:
        return
    places = [result.settings['value'] for result in results]
    axes.plot(places, [result.values['predicted'] for result in results], 'k-')
    if 'any_shape' in results[0].values:
        axes.plot(places, [result.values['any_shape'] for result in results], 'k--')
    axes.plot(places, [result.values['measured'] for result in results], 'o',
              color=_COLORS[UNSTABLE])
    if min(places) > 0.0:
        axes.set_xscale('log')
    else:
        axes.set_xscale('symlog', linthresh=min(place for place in places if place > 0.0))
    axes.set_xticks(places, [f'{place:g}' for place in places])
    axes.set_xticks([], minor=True)
    axes.set_yscale('log')
    low, high = axes.get_ylim()
    if high < 3.0 * low:
        axes.set_ylim(low / 1.5, high * 1.5)
    axes.grid(True, which='major', color='#dddddd')
    axes.set_axisbelow(True)


def _widest(results: Sequence[Result]) -> str:
    """Return the family that the stiffness axis is named after: the stiffest of the scene."""
    scene = Scene(results[0].scene)
    return max(('structural', 'shear', 'bend'), key=scene.stiffness)


def _borders(centres: np.ndarray) -> np.ndarray:
    """Return where cells around ``centres``, evenly spaced in their logarithm, meet."""
    logs = np.log(centres)
    half = 0.5 * (logs[1] - logs[0])
    return np.exp(np.append(logs - half, logs[-1] + half))
