# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How much strain there is, over any number of frames."""

import math

import numpy as np

_LEAST, _MOST = 1e-6, 1e3
_BINS = 2000


class StrainRange:
    """Counts strains by size, so that a share of them can be told without keeping them."""

    def __init__(self) -> None:
        """Begin with no strain."""
        self.largest = math.nan
        self._edges = np.geomspace(_LEAST, _MOST, _BINS)
        self._counts = np.zeros(_BINS + 1, np.int64)

    @property
    def is_known(self) -> bool:
        """Tell whether some strain was given."""
        return not math.isnan(self.largest)

    def add(self, strain: np.ndarray) -> None:
        """Take up the strains of a frame, of any shape; those that are no number are left out."""
        known = strain[np.isfinite(strain)]
        if known.size:
            self.largest = float(np.fmax(self.largest, known.max()))
            places = np.searchsorted(self._edges, known.ravel(), side='right')
            self._counts += np.bincount(places, minlength=_BINS + 1)

    def above(self, share: float) -> float:
        """Return the strain that ``share`` (0 to 1) of all strains stay below, to 1 percent."""
        total = np.cumsum(self._counts)
        place = int(np.searchsorted(total, share * total[-1]))
        return float(self._edges[place - 1]) if place else 0.0
