# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Fig. 7, 8 and 9 of the paper: printed frame rates on the left, measured ones on the right."""

from collections.abc import Sequence
from pathlib import Path

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.paper.printed import printed_speeds
from cloth_sim_ros.study.paper.printed import REAL_TIME
from cloth_sim_ros.study.paper.printed import TABLE
from cloth_sim_ros.study.paper.timing import Speed
from cloth_sim_ros.study.paper.timing import TimedCloth
from cloth_sim_ros.study.paper.timing import without_bend
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator
from matplotlib.ticker import NullFormatter

_SIZE = (11.0, 5.4)
_DPI = 110
# Serial programs in greys, shaders in colours that are distinct without colour vision.
_COLOURS = {
    'serial': '#606060', "serial, the paper's matrix": '#606060', 'serial, no matrix': '#a0a0a0',
    "GLSL, the paper's two passes": '#d55e00', "GLSL, the paper's solver": '#d55e00',
    "GLSL, the paper's scheme": '#d55e00', 'GLSL, one solve a step': '#56b4e9',
    'GLSL, defaults': '#0072b2'}
_PRINTED = (('cpu_fps', 's', '#606060', 'CPU, one core'), ('gpu_fps', 'o', '#d55e00', 'GPU'))
_DASHED = ' (dashed: no bend edges)'


def write_plot(path: str | Path, method: str, title: str, cloths: Sequence[TimedCloth]) -> None:
    """
    Write the figure of ``method`` as PNG.

    :raises ClothSimError: when the file cannot be written
    """
    figure = Figure(figsize=_SIZE, layout='constrained')
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    _draw_printed(left, method)
    _draw_measured(right, cloths)
    for axes, name in (
            (left, 'printed: i7-7700, GTX 1070'), (right, f'here: {cloths[0].device}')):
        axes.set_title(name, fontsize=10)
        axes.set(xscale='log', yscale='log', xlabel='nodes')
        axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
        axes.xaxis.set_major_formatter(lambda nodes, _: f'{nodes:,.0f}')
        axes.xaxis.set_minor_formatter(NullFormatter())
        axes.axhline(REAL_TIME, color='0.6', linewidth=1.0, linestyle=':')
        axes.grid(True, which='major', color='0.9')
        axes.set_axisbelow(True)
    left.set_ylabel('frames per second')
    figure.legend(loc='outside lower center', ncols=3, fontsize=8, frameon=False)
    figure.suptitle(title, fontsize=11)
    try:
        figure.savefig(path, dpi=_DPI, format='png')
    except OSError as error:
        raise ClothSimError(
            f'{path} cannot be written ({error.strerror}): give another --plot') from error


def _draw_printed(axes: Axes, method: str) -> None:
    speeds = [speed for speed in printed_speeds() if speed.method == method]
    for name, marker, colour, label in _PRINTED:
        points = [
            (speed.nodes, fps) for speed in speeds
            if speed.source == TABLE and (fps := getattr(speed, name)) is not None]
        if points:
            axes.plot(*zip(*points), marker, linestyle='-', color=colour, markersize=5,
                      label=f'{label} ({TABLE})')
    for speed in speeds:
        if speed.source != TABLE:
            axes.plot(speed.nodes, REAL_TIME, '*', color='#d55e00', markersize=13,
                      label=f'GPU, {REAL_TIME:g} fps or more ({speed.source})')


def _draw_measured(axes: Axes, cloths: Sequence[TimedCloth]) -> None:
    groups: dict[tuple[str, bool], list[tuple[int, Speed]]] = {}
    for cloth in cloths:
        for speed in cloth.speeds:
            if speed.fps is not None:
                groups.setdefault((speed.contender, bool(without_bend(cloth))), []).append(
                    (cloth.nodes, speed))
    both = {name for name, is_dashed in groups if is_dashed}
    for (name, is_dashed), points in groups.items():
        middle = [speed.fps or 0.0 for _, speed in points]
        ranges = [
            [fps - min(speed.rounds) for fps, (_, speed) in zip(middle, points)],
            [max(speed.rounds) - fps for fps, (_, speed) in zip(middle, points)]]
        label = None if is_dashed and (name, False) in groups else (
            name + _DASHED * (name in both))
        axes.errorbar(
            [nodes for nodes, _ in points], middle, ranges,
            linestyle='--' if is_dashed else '-', color=_COLOURS[name], marker='o', markersize=4,
            linewidth=1.3, capsize=2, label=label)
