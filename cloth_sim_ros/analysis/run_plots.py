# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""Which plots a run has, and what is in them."""

from collections.abc import Iterator

from cloth_sim_ros.analysis.pin_columns import LARGEST
from cloth_sim_ros.analysis.pin_columns import SUM
from cloth_sim_ros.analysis.run import Run
from cloth_sim_ros.analysis.strain_plot import strain_histogram_plot
from cloth_sim_ros.analysis.time_plot import Line
from cloth_sim_ros.analysis.time_plot import Panel
from cloth_sim_ros.analysis.time_plot import time_plot
from matplotlib.figure import Figure
import numpy as np

_PLOTS = {
    'energies': ('Energies', (
        Panel('energy [J]', (
            Line('kinetic_energy', 'kinetic'), Line('elastic_energy', 'elastic'),
            Line('gravitational_energy', 'gravitational'), Line('total_energy', 'total'))),)),
    'strain': ('Strain |l / L0 - 1|', (
        Panel('strain [%]', (
            Line('max_strain', 'largest of all springs', 100.0),
            Line('mean_strain', 'mean of the nodes', 100.0))),)),
    'pin_forces': ('Forces of the cloth on its pins', (
        Panel('sum of all pins [N]', tuple(
            Line(name, axis) for name, axis in zip(SUM, 'xyz'))),
        Panel('largest of a pin [N]', (Line(LARGEST, 'largest'),)))),
    'constraints': ('Edges at their strain limit', (
        Panel('active constraints', (Line('active_constraints', 'active'),)),
        Panel('switches in the last step', (Line('constraint_switches', 'switches'),)))),
    'solver': ('Linear solver', (
        Panel('iterations, most of a solve', (Line('solver_iterations', 'iterations'),)),
        Panel('relative residual, worst solve', (Line('solver_residual', 'residual'),), 'log'))),
    'pace': ('Pace', (
        Panel('wall time of a step [ms]', (
            Line('step_wall_time', 'step of dt', 1e3, above_zero=True),), 'auto'),
        Panel('real-time factor', (
            Line('real_time_factor', 'simulated / wall', above_zero=True),), 'auto'))),
}
# What shows by being above 0 that a run has it.
_SIGNS = {
    'constraints': 'active_constraints', 'solver': 'solver_iterations', 'pace': 'step_wall_time'}


def run_plots(run: Run) -> Iterator[tuple[str, Figure]]:
    """Yield name and figure of each plot of what the run has."""
    for name, (title, panels) in _PLOTS.items():
        if all(any(run.has(line.column) for line in panel.lines) for panel in panels) and (
                _has_part(run, name)):
            yield name, time_plot(run, f'{title}: {_heading(run)}', panels)
    if run.has('mean_strain'):
        yield 'strain_histogram', strain_histogram_plot(
            run, f'Strain of the nodes: {_heading(run)}')


def _has_part(run: Run, name: str) -> bool:
    if name == 'constraints' and 'adaptive' in run.modes.modes:
        return True
    return name not in _SIGNS or bool(np.nanmax(run.columns[_SIGNS[name]]) > 0.0)


def _heading(run: Run) -> str:
    modes = ', '.join(run.modes.modes)
    size = f'{run.rows} x {run.cols} nodes' if run.rows else ''
    return ', '.join(filter(None, (run.name, size, modes)))
