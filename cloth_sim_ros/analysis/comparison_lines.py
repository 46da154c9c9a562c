# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


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
