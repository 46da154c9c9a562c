# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run came to, by its recording alone."""

from dataclasses import dataclass

from cloth_sim_ros.analysis.run import Run
import numpy as np


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
