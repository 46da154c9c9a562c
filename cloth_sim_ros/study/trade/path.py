# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a cloth has been, on points that cloths of any resolution have in common."""

from dataclasses import dataclass

from cloth_sim_ros.study.results import Result
import numpy as np


@dataclass(frozen=True)
class Path:
    """
    What a run looked like.

    :param positions: at the times of the study, (times, rows, cols, 3) float64 [m]
    :param strains: largest of structural and shear springs, at every frame
    :param energies: kinetic, elastic and gravitational, (frames, 3) [J]
    """

    positions: np.ndarray
    strains: np.ndarray
    energies: np.ndarray

    def on_nodes_of(self, rows: int, cols: int) -> 'Path':
        """Return the path of the points where a cloth of ``rows`` x ``cols`` has its nodes."""
        along = _resampled(self.positions, rows, 1)
        return Path(_resampled(along, cols, 2), self.strains, self.energies)


def path_of(result: Result) -> Path:
    """Return the path that a run left in its arrays."""
    return Path(**{
        name: result.arrays[name].astype(float) for name in ('positions', 'strains', 'energies')})


def distances(path: Path, other: Path) -> np.ndarray:
    """Return the RMS distance of the same nodes at each time [m]."""
    squares = np.sum((path.positions - other.positions)**2, axis=-1)
    return np.sqrt(squares.mean(axis=(1, 2)))


def _resampled(values: np.ndarray, count: int, axis: int) -> np.ndarray:
    """Return ``values`` at ``count`` points evenly along ``axis``, linear between nodes."""
    present = values.shape[axis]
    if count == present:
        return values
    place = np.linspace(0.0, present - 1.0, count)
    first = np.minimum(place.astype(int), max(present - 2, 0))
    share = np.expand_dims(place - first, tuple(i for i in range(values.ndim) if i != axis))
    following = np.minimum(first + 1, present - 1)
    return (1.0 - share) * values.take(first, axis) + share * values.take(following, axis)
