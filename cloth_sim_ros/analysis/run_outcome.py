# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run came to, by its recording alone; several as a Markdown table."""

from collections.abc import Iterable
from dataclasses import dataclass

from cloth_sim_ros.analysis.run import Run
import numpy as np

_HEAD = (
    'run', 'dt [s]', 'substeps a dt', 'largest strain', 'beyond its limit',
    'peak kinetic energy [J]', 'end', 'wall time [s]')


@dataclass(frozen=True)
class RunOutcome:
    """
    Peaks are those of the recorded frames.

    :param end: time of the last frame [s]
    :param dt: [s]
    :param substeps: of a dt, mean over the frames that moved on
    :param max_strain: largest of any structural or shear spring
    :param kinetic_energy: largest [J]
    :param stability_margin: largest; above 1 the substep is longer than is stable
    :param wall_seconds: spent on the steps
    :param device: GL_RENDERER
    :param stopped: True when the next state was not finite
    """

    end: float = 0.0
    dt: float = 0.0
    substeps: float = 0.0
    max_strain: float = 0.0
    kinetic_energy: float = 0.0
    stability_margin: float = 0.0
    wall_seconds: float = 0.0
    device: str = ''
    stopped: bool = False

    @classmethod
    def of(cls, run: Run) -> 'RunOutcome':
        """Return the outcome of ``run``, which was recorded without a reset."""
        columns = run.columns
        dt = float(columns['dt'][-1])
        steps = np.round(np.diff(columns['time']) / dt)
        moved = steps > 0.0
        return cls(
            end=float(columns['time'][-1]), dt=dt,
            substeps=float(columns['substeps'][1:][moved].mean()) if moved.any() else 0.0,
            max_strain=float(columns['max_strain'].max()),
            kinetic_energy=float(columns['kinetic_energy'].max()),
            stability_margin=float(columns['stability_margin'].max()),
            wall_seconds=float(np.sum(steps * columns['step_wall_time'][1:])),
            device=run.device, stopped=run.stopped)


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
