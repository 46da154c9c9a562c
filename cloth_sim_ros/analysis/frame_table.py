# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The figures of all frames of a recording, one row each."""

from collections.abc import Mapping

import numpy as np

# What is taken from ~/stats, under its own names.
STATS = (
    'dt', 'substeps', 'stability_margin', 'kinetic_energy', 'elastic_energy',
    'gravitational_energy', 'total_energy', 'max_strain', 'solver_iterations',
    'solver_residual', 'solver_reached', 'active_constraints', 'active_fraction',
    'constraint_switches', 'lengths_are_held', 'stalled_pins', 'sticking_nodes',
    'sliding_nodes', 'deepest_node', 'step_wall_time', 'real_time_factor')
# What is computed from ~/points.
POINTS = ('mean_strain', 'mean_height')
COLUMNS = ('time', 'resets', *STATS, *POINTS)
_BEGIN = 1024  # rows


class FrameTable:
    """
    Rows of COLUMNS, each of one moment; nan where nothing was said.

    Topics may come in any order, and a moment more than once: what comes last counts.
    """

    def __init__(self) -> None:
        """Begin without rows."""
        self._values = np.full((_BEGIN, len(COLUMNS)), np.nan)
        self._rows: dict[tuple[int, float], int] = {}

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self._rows)

    def put(self, resets: int, time: float, values: Mapping[str, float]) -> None:
        """Write ``values`` into the row of ``time`` [s] after ``resets`` resets."""
        row = self._rows.setdefault((resets, time), len(self._rows))
        if row == len(self._values):
            self._values = np.concatenate([self._values, np.full_like(self._values, np.nan)])
        self._values[row, :2] = time, resets
        for name, value in values.items():
            self._values[row, _PLACES[name]] = value

    def columns(self) -> dict[str, np.ndarray]:
        """Return all columns by name, in the order of time."""
        values = self._values[:len(self)]
        values = values[np.lexsort((values[:, 0], values[:, 1]))]
        return dict(zip(COLUMNS, values.T.copy()))


_PLACES = {name: place for place, name in enumerate(COLUMNS)}
