# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth as what RViz and Foxglove can draw: triangles, or a line for a chain."""

from cloth_sim_ros.messages.triangles import triangles
import numpy as np

# Nodes drawn along each side at most: more make a message that no viewer needs.
MOST_DRAWN = 256
# A point of three float64 and a colour of four float32.
_BYTES_A_CORNER = 3 * 8 + 4 * 4


def surface_bytes(rows: int, cols: int) -> int:
    """Return how large the points and colours of the surface are [bytes]."""
    if min(rows, cols) == 1:
        return rows * cols * _BYTES_A_CORNER
    return 6 * (min(rows, MOST_DRAWN) - 1) * (min(cols, MOST_DRAWN) - 1) * _BYTES_A_CORNER


def _sampled(count: int, limit: int) -> np.ndarray | slice:
    if count <= limit:
        return slice(None)
    return np.linspace(0, count - 1, limit).round().astype(np.intp)


class Surface:
    """
    Which nodes are drawn, and in which order.

    :param max_side: nodes drawn along each side at most; larger cloths are sampled evenly
    """

    def __init__(self, rows: int, cols: int, max_side: int) -> None:
        """Choose the nodes."""
        self.is_chain = min(rows, cols) == 1
        limit = max(rows, cols) if self.is_chain else max_side
        self._rows = _sampled(rows, limit)
        self._cols = _sampled(cols, limit)
        corners = triangles(min(rows, limit), min(cols, limit))
        self._order = np.arange(rows * cols) if self.is_chain else corners.ravel().astype(np.intp)
        self._points = np.empty((len(self._order), 3))
        self._colors = np.empty((len(self._order), 4), np.float32)

    def sample(self, values: np.ndarray) -> np.ndarray:
        """Return ``values``, (rows, cols, ...), at the nodes drawn, one behind the other."""
        chosen = values[self._rows][:, self._cols]
        return chosen.reshape(-1, *values.shape[2:])

    def points(self, positions: np.ndarray) -> np.ndarray:
        """Return the corners to draw, from sampled ``positions``; valid until the next call."""
        return np.take(
            positions.astype('<f8', copy=False), self._order, axis=0, out=self._points,
            mode='clip')

    def colors(self, colors: np.ndarray) -> np.ndarray:
        """Return the colours of those corners, from sampled ``colors``; valid likewise."""
        # As one 16-byte item each, which NumPy gathers faster than four floats.
        np.take(
            colors.view(np.complex128)[:, 0], self._order,
            out=self._colors.view(np.complex128)[:, 0], mode='clip')
        return self._colors
