# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far the scene reaches, over any number of frames."""

import numpy as np

_DIRECTIONS = 256
_SIDE = 64        # nodes looked at along each side of a frame, its last ones among them


class Extent:
    """Keeps, of all points given, those that reach farthest in some direction."""

    def __init__(self) -> None:
        """Begin with no point."""
        self._directions = _even_directions(_DIRECTIONS)
        self._reach = np.full(len(self._directions), -np.inf)
        self._farthest = np.zeros((len(self._directions), 3))

    @property
    def points(self) -> np.ndarray:
        """Get the points that were kept [m], (n, 3); none before the first was given."""
        return self._farthest[np.isfinite(self._reach)]

    @property
    def low(self) -> np.ndarray:
        """Get the lowest x, y and z of all points [m]."""
        return self.points.min(axis=0)

    @property
    def high(self) -> np.ndarray:
        """Get the highest x, y and z of all points [m]."""
        return self.points.max(axis=0)

    @property
    def size(self) -> float:
        """Get the longest of the sides along x, y and z [m]."""
        return float(np.max(self.high - self.low))

    def add(self, points: np.ndarray) -> None:
        """Take up ``points``, (..., 3) [m]; those that are not finite are left out."""
        flat = points.reshape(-1, 3)
        flat = flat[np.isfinite(flat).all(axis=1)]
        if not len(flat):
            return
        reach = flat @ self._directions.T
        best = reach.argmax(axis=0)
        farther = reach.max(axis=0) > self._reach
        self._reach[farther] = reach.max(axis=0)[farther]
        self._farthest[farther] = flat[best[farther]]

    def add_nodes(self, positions: np.ndarray) -> None:
        """Take up a cloth, (rows, cols, 3) [m]; of a fine one, evenly chosen nodes."""
        rows, cols = (_chosen(count) for count in positions.shape[:2])
        self.add(positions[np.ix_(rows, cols)])


def _chosen(count: int) -> np.ndarray:
    return np.unique(np.linspace(0, count - 1, min(count, _SIDE)).round().astype(int))


def _even_directions(count: int) -> np.ndarray:
    """Return unit vectors on a spiral over the sphere, and the axes first."""
    number = np.arange(count) + 0.5
    height = 1.0 - 2.0 * number / count
    turn = np.pi * (1.0 + np.sqrt(5.0)) * number
    ring = np.sqrt(1.0 - height**2)
    spiral = np.stack([ring * np.cos(turn), ring * np.sin(turn), height], axis=1)
    return np.concatenate([np.eye(3), -np.eye(3), spiral])
