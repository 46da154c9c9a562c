# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The colours of strain, and the range that they span."""

import math

from cloth_sim_ros.sim.errors import ClothSimError
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.colors import Normalize
import numpy as np

_LEAST_STRAIN, _MOST = 1e-6, 1e3
_BINS = 2000
PALETTE_SIZE = 256
# Light at rest: folds are seen by their shade, which a dark colour would hide.
_COLORS = LinearSegmentedColormap.from_list(
    'strain', ('#c3d3e8', '#e6dfae', '#f4b942', '#e0632b', '#9c1429'), N=PALETTE_SIZE)
_SHARE = 0.995        # of the nodes whose strain the colours tell apart
_LEAST = 1e-3
_STEPS = (1.0, 2.0, 5.0)


class StrainRange:
    """Counts strains by size, so that a share of them can be told without keeping them."""

    def __init__(self) -> None:
        """Begin with no strain."""
        self.largest = math.nan
        self._edges = np.geomspace(_LEAST_STRAIN, _MOST, _BINS)
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


class StrainScale:
    """
    Colours for all strains of a range alike.

    :param full: strain of the last colour; None fits it to the range
    :raises ClothSimError: when ``full`` is not above 0
    """

    def __init__(self, strains: StrainRange, full: float | None = None) -> None:
        """Fit the scale."""
        if full is not None and not 0.0 < full < math.inf:
            raise ClothSimError(
                f'the strain of the last colour must be above 0, got {full:g}: give 0.05 for 5 %')
        self.is_known = strains.is_known
        self.largest = strains.largest
        fitted = round_up(max(strains.above(_SHARE), _LEAST)) if strains.is_known else _LEAST
        self.full = fitted if full is None else full
        self.in_percent = ScalarMappable(Normalize(0.0, 100.0 * self.full), _COLORS)

    @property
    def is_exceeded(self) -> bool:
        """Tell whether some node has more strain than the last colour stands for."""
        return self.largest > self.full

    @property
    def palette(self) -> np.ndarray:
        """Get red, green, blue, alpha from 0 to 1 of even steps, (PALETTE_SIZE, 4) float32."""
        return _COLORS(np.arange(PALETTE_SIZE)).astype(np.float32)

    def colors(self, strain: np.ndarray) -> np.ndarray:
        """Return red, green, blue, alpha from 0 to 1 of each strain, (..., 4)."""
        return _COLORS(strain / self.full)


def round_up(value: float) -> float:
    """Return the next of 1, 2 and 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(value))
    return next((step * power for step in _STEPS if value <= step * power), 10.0 * power)
