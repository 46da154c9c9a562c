# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""What the marks in a picture mean."""

from cloth_sim_ros.analysis.rendering.look import GRID_COLOR
from cloth_sim_ros.analysis.rendering.look import LIMIT_COLOR
from cloth_sim_ros.analysis.rendering.look import PIN_COLOR
from cloth_sim_ros.analysis.rendering.look import PUSH_COLOR
from cloth_sim_ros.analysis.rendering.survey import Survey
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
