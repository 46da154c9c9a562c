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


"""A comparison in words, one line for each part."""

from cloth_sim_ros.analysis.comparison import Comparison
from cloth_sim_ros.analysis.summary_lines import figure
import numpy as np


def comparison_lines(comparison: Comparison) -> dict[str, str]:
    """Return the lines of a comparison by their names."""
    lines = {
        'compared': f'{comparison.second} with {comparison.first}, at their common times',
        'matched': f'{len(comparison.times)} frames from {comparison.times[0]:.6g} to '
                   f'{comparison.times[-1]:.6g} s; {comparison.unmatched[0]} and '
                   f'{comparison.unmatched[1]} are in only one of them',
    }
    if comparison.identical:
        lines['node distance'] = 'none: all positions are bitwise identical'
    else:
        lines['node distance'] = _line(comparison.rms_distance, ' m', 'RMS')
    lines['max strain'] = _line(comparison.strain_difference, '', 'difference')
    lines['total energy'] = _line(comparison.energy_difference, ' J', 'difference')
    return lines


def _line(series: np.ndarray, unit: str, what: str) -> str:
    told = series[np.isfinite(series)]
    if not len(told):
        return 'unknown: not in both recordings'
    most = told[np.argmax(np.abs(told))]
    return f'{what} {figure(told[-1])}{unit} at the end, peak {figure(most)}{unit}'
