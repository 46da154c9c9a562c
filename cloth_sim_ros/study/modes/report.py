# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The comparison of modes as a table."""

from cloth_sim_ros.study.modes.comparison import ModeComparison
from cloth_sim_ros.study.modes.comparison import ModeSpeed

_HEAD = (
    '| N | | real-time factor | over mass_spring (rounds) | by processor time | peak stretch '
    '| 95th percentile: worst frame, all | substeps/s | solves/s | iterations a solve '
    '| energy rise / M g L | stretch within bound |',
    '|---|---|---|---|---|---|---|---|---|---|---|---|')


def comparison_table(comparison: ModeComparison) -> str:
    """Return the table in Markdown, with what was measured above and the growth below."""
    cloth = comparison.cloth
    lines = [
        f'{cloth["width"]:g} x {cloth["height"]:g} m, {cloth["areal_density"]:g} kg/m2, pins '
        f'{" ".join(cloth["pins"])}, {comparison.seconds:g} s from level, {comparison.rounds} '
        f'rounds, {1e3 * comparison.frame:g} ms of each in turn, on {comparison.device}',
        '', *_HEAD, *map(_row, comparison.speeds)]
    if comparison.growth:
        exponents = ', '.join(
            f'{name} {exponent:.1f}' for name, exponent in comparison.growth.items())
        lines += ['', f'Wall time grows with N to the power of: {exponents}']
    return '\n'.join(lines)


def _row(speed: ModeSpeed) -> str:
    if speed.failure is not None:
        return f'| {speed.grid} | {speed.contender} | {speed.failure} |' + 9 * ' |'
    stretch, rise = speed.stretch, speed.energy_rise
    assert stretch is not None and rise is not None  # it has no failure
    cells = [
        speed.grid, speed.contender, f'{speed.real_time_factor:.3g}', _ratio(speed),
        '-' if speed.processor_ratio is None else f'{speed.processor_ratio:.3g}',
        f'{100.0 * stretch.peak:.2f} %',
        f'{100.0 * stretch.worst_frame_percentile:.2f} %, {100.0 * stretch.percentile:.2f} %',
        f'{speed.substep_rate:.0f}', f'{speed.solve_rate:.0f}' if speed.solve_rate else '-',
        '-' if speed.iterations_per_solve is None else f'{speed.iterations_per_solve:.1f}',
        f'{100.0 * rise:.2f} %',
        f'{"yes" if speed.is_within_bound else "NO"} ({speed.bound})']
    return f'| {" | ".join(map(str, cells))} |'


def _ratio(speed: ModeSpeed) -> str:
    if speed.ratio is None:
        return '-'
    return f'{speed.ratio:.3g} ({min(speed.ratios):.3g} to {max(speed.ratios):.3g})'
