# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The figures of all frames of a recording, one row each, and its histogram of strain."""

from collections.abc import Mapping

import numpy as np

# Columns from ~/stats, named as there.
STATS = (
    'dt', 'substeps', 'stability_margin', 'kinetic_energy', 'elastic_energy',
    'gravitational_energy', 'total_energy', 'max_strain', 'solver_iterations',
    'solver_residual', 'solver_reached', 'active_constraints', 'active_fraction',
    'constraint_switches', 'calm_substeps', 'listed_substeps', 'whole_substeps', 'listed_edges',
    'limit_rounds', 'limit_unreached', 'strain_over_bound', 'lengths_are_held', 'settling',
    'settling_work', 'stalled_pins', 'air_margin', 'sticking_nodes', 'sliding_nodes',
    'deepest_node', 'self_contacts', 'layer_overlap', 'cut_nodes', 'largest_cut',
    'halved_substeps', 'surface_contact_held', 'step_wall_time', 'real_time_factor')
# Columns computed from ~/points.
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


# How many nodes have how much strain, over frames that come one by one.

# The bits of a float32 grow with it: its first bits are bins of 1/256 of an octave, found
# without a logarithm, from 2^-30 to 2^6. What is beyond falls into the first or the last.
_SHIFT = 15
_FIRST = (127 - 30) << (23 - _SHIFT)
_BINS = 36 << (23 - _SHIFT)
_EDGES = np.arange(_FIRST, _FIRST + _BINS + 1, dtype=np.int32) << _SHIFT
_MIDDLES = (_EDGES[:-1] + (1 << (_SHIFT - 1))).view(np.float32).astype(float)


class StrainHistogram:
    """Counts the nodes of all frames, and those of the last one, by their strain."""

    def __init__(self) -> None:
        """Begin without a node."""
        self._all = np.zeros(_BINS, np.int64)
        self._last = np.zeros(_BINS, np.int64)

    def add(self, strain: np.ndarray) -> None:
        """Count the nodes of a frame by their ``strain``, (rows, cols)."""
        bits = np.ascontiguousarray(strain, np.float32).ravel().view(np.int32)
        bins = (bits >> _SHIFT) - _FIRST
        np.clip(bins, 0, _BINS - 1, out=bins)
        self._last = np.bincount(bins, minlength=_BINS)
        self._all += self._last

    def shares(self, edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """
        Return the shares of the nodes between ``edges``: of all frames, and of the last.

        :param edges: of at least 0.5 % of the largest one apart, or strains would be sorted
            wrongly; what is beyond the last is in none
        """
        return _shares(self._all, edges), _shares(self._last, edges)


def _shares(counts: np.ndarray, edges: np.ndarray) -> np.ndarray:
    middles = np.concatenate([[0.0], _MIDDLES[1:]])
    return np.histogram(middles, edges, weights=counts)[0] / max(counts.sum(), 1)
