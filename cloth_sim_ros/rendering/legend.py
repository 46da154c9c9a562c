# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the marks in a picture mean."""

from cloth_sim_ros.rendering.look import GRID_COLOR
from cloth_sim_ros.rendering.look import LIMIT_COLOR
from cloth_sim_ros.rendering.look import PIN_COLOR
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.survey import Survey
from matplotlib.lines import Line2D


def legend_handles(survey: Survey, grid: float, size: float) -> list[Line2D]:
    """
    Return an entry for each kind of mark that some panel has.

    :param grid: distance of the grid's lines [m]
    :param size: of the marks [point]
    """
    entries = [(f'grid {grid:g} m', {'color': GRID_COLOR, 'linewidth': 1.5})]
    if survey.shows_pins:
        entries.append(('pinned', _dot(PIN_COLOR, size)))
    if survey.shows_pushes:
        # An arrowhead at the end of its shaft.
        entries.append(('push', {
            'color': PUSH_COLOR, 'linewidth': 2.0, 'marker': '>', 'markersize': size,
            'markevery': [1]}))
    if survey.shows_limits:
        entries.append(('node at its strain limit', _dot(LIMIT_COLOR, 0.8 * size)))
    return [Line2D([0.0, 1.0], [0.0, 0.0], label=label, **look) for label, look in entries]


def _dot(color: tuple[float, float, float], size: float) -> dict[str, object]:
    return {
        'linestyle': 'none', 'marker': 'o', 'color': color, 'markersize': size,
        'markevery': [0], 'markeredgewidth': 0.0}
