# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""How many nodes have how much strain, over frames that come one by one."""

import numpy as np

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
