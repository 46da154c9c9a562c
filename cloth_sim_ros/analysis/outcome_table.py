# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Runs side by side, as a Markdown table."""

from collections.abc import Iterable

from cloth_sim_ros.analysis.run_outcome import RunOutcome

_HEAD = (
    'run', 'dt [s]', 'substeps a dt', 'largest strain', 'beyond its limit',
    'peak kinetic energy [J]', 'end', 'wall time [s]')


def outcome_table(rows: Iterable[tuple[str, RunOutcome, float | None]]) -> str:
    """
    Return the table.

    :param rows: label, outcome, and the strain that the method allows: 0 where edges keep their
        length, None where it allows any
    """
    lines = [_HEAD, ('---',) * len(_HEAD)]
    lines.extend(_cells(*row) for row in rows)
    return '\n'.join(f'| {" | ".join(cells)} |' for cells in lines)


def end_of(outcome: RunOutcome) -> str:
    """Return how the run ended, in words."""
    if outcome.stopped:
        return f'not finite after {outcome.end:.3g} s'
    return f'{outcome.end:.3g} s, finite'


def _cells(label: str, outcome: RunOutcome, allowed: float | None) -> tuple[str, ...]:
    return (
        label, f'{outcome.dt:g}', f'{outcome.substeps:.1f}', _percent(outcome.max_strain),
        '-' if allowed is None else _percent(max(0.0, outcome.max_strain - allowed)),
        f'{outcome.kinetic_energy:.4g}', end_of(outcome), f'{outcome.wall_seconds:.2g}')


def _percent(strain: float) -> str:
    return f'{100.0 * strain:.3g} %'
