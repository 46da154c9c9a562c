# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""A summary in words, one line for each part."""

from collections.abc import Sequence
import math

from cloth_sim_ros.analysis.summary import Summary

_MOST_SHOWN = 4


def summary_lines(summary: Summary) -> dict[str, str]:
    """Return the lines of a recording by their names."""
    lines = {
        'cloth': f'{summary.rows} x {summary.cols} nodes' if summary.rows else 'not recorded',
        'mode': ', '.join(summary.modes) or 'not recorded',
        'device': summary.device or 'not recorded',
        'time': f'{summary.begin:.6g} to {summary.end:.6g} s, {summary.frames} frames',
        'dt': f'{figure(summary.dt, ".6g")} s in {figure(summary.substeps, ".6g")} substeps',
        'real-time factor': f'{summary.real_time_factor:.3g}, median while running',
        'step time': f'{figure(1e3 * summary.step_wall_time)} ms per time step, median',
        'inputs': f'pushes: {summary.pushes}, nodes released: {summary.releases}, '
                  f'pinned: {summary.pins}, resets: {summary.resets}',
        'max strain': f'{figure(summary.last_strain)} at the end, '
                      f'peak {figure(summary.largest_strain)}',
        'mean strain': f'{figure(summary.mean_strain)}, over all nodes and frames',
        'kinetic energy': f'{figure(summary.last_kinetic_energy)} J at the end, '
                          f'peak {figure(summary.largest_kinetic_energy)} J',
        'total energy': f'{figure(summary.first_energy, ".4g")} J at the start, '
                        f'{figure(summary.last_energy, ".4g")} J at the end',
    }
    if summary.solver_iterations > 0:
        lines['solver'] = (
            f'at most {summary.solver_iterations:.0f} iterations, worst residual '
            f'{summary.solver_residual:.3g}, {summary.solver_missed} frames above the tolerance')
    if summary.most_active > 0:
        lines['constraints'] = f'at most {summary.most_active:.0f} active'
    if summary.lengths_lost:
        lines['lengths'] = f'far off in {summary.lengths_lost} frames'
    if summary.stalled:
        lines['stalled pins'] = f'in {summary.stalled} frames'
    if summary.switches:
        lines['mode switches'] = _listed([
            f'{mode} at {time:.6g} s' for time, _, mode in summary.switches])
    if summary.gaps:
        lines['gaps'] = _listed([f'{begin:.6g} to {end:.6g} s' for begin, end in summary.gaps])
    if summary.missing:
        lines['not recorded'] = ', '.join(summary.missing)
    lines['state'] = 'finite' if summary.finite else 'became non-finite'
    if summary.problems:
        lines['problems'] = '; '.join(summary.problems)
    return lines


def text_table(lines: dict[str, str]) -> str:
    """Return ``lines`` below each other."""
    return '\n'.join(f'{name:18} {value}' for name, value in lines.items())


def figure(value: float, form: str = '.3g') -> str:
    """Return a number, or that there is none."""
    return f'{value:{form}}' if math.isfinite(value) else 'unknown'


def _listed(parts: Sequence[str]) -> str:
    more = len(parts) - _MOST_SHOWN
    return ', '.join(parts[:_MOST_SHOWN]) + (f' and {more} more' if more > 0 else '')
