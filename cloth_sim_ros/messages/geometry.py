# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What viewers draw: triangles coloured by strain, a line for a chain, arrows of pushes."""

from collections.abc import Iterable

from cloth_sim_ros.messages.cdr_writer import CdrWriter
from cloth_sim_ros.sim.mesh import sampled_cells
from cloth_sim_ros.sim.mesh import triangles
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
import numpy as np


def push_arrows(
        pushes: Iterable[Push], time: float, nodes: np.ndarray,
        length: float) -> list[np.ndarray]:
    """
    Return tail and tip of an arrow for each push that acts at ``time`` [s].

    :param nodes: positions of nodes, (n, 3) [m], NaN for none; their mean is the middle of the
        cloth
    :param length: of the arrow of the largest force [m]
    :return: (2, 3) float64 each [m]
    """
    active = [push for push in pushes if push.start <= time < push.end]
    forces = [np.array(push.force) for push in active]
    largest = max((np.linalg.norm(force) for force in forces), default=0.0)
    if largest == 0.0:
        return []
    arrows = []
    for push, force in zip(active, forces):
        tail = np.array(push.center)
        if push.region == 'all':
            tail = np.nanmean(nodes, axis=0, dtype=float)
        arrows.append(np.stack([tail, tail + force * (length / largest)]))
    return arrows


# What RViz and Foxglove draw: triangles coloured by strain, or a line for a chain.

FULL_STRAIN = 0.1  # drawn, like all above it, in the last colour

# The viridis map of matplotlib at eleven places, 0 to 1.
_VIRIDIS = (
    '440154', '482475', '414487', '355f8d', '2a788e', '21918c',
    '22a884', '44bf70', '7ad151', 'bddf26', 'fde725')
_STEPS = 256
# Nodes drawn along each side at most: more make a message that no viewer needs.
MOST_DRAWN = 256
# A point of three float64 and a colour of four float32.
_BYTES_A_CORNER = 3 * 8 + 4 * 4


def serialise_topology(scene: Scene) -> bytes:
    """Return the CDR bytes of the shape_msgs/Mesh of ``scene`` at rest."""
    writer = CdrWriter()
    writer.put_sequence(triangles(scene.rows, scene.cols, scene.cut_cells))
    writer.put_sequence(scene.rest_positions().reshape(-1, 3).astype('<f8', copy=False))
    return writer.finish()


def _palette() -> np.ndarray:
    anchors = np.array([list(bytes.fromhex(color)) for color in _VIRIDIS]) / 255.0
    places = np.linspace(0.0, 1.0, _STEPS)
    known = np.linspace(0.0, 1.0, len(anchors))
    channels = [np.interp(places, known, anchors[:, channel]) for channel in range(3)]
    return np.stack([*channels, np.ones(_STEPS)], axis=-1).astype('<f4')


_PALETTE = _palette()


def strain_colors(strain: np.ndarray) -> np.ndarray:
    """
    Return the colour of each strain, dark at rest and bright from FULL_STRAIN on.

    :param strain: of any shape, 0 or more; NaN gets the last colour
    :return: red, green, blue, alpha from 0 to 1, shape (..., 4) float32
    """
    steps = np.fmin(strain * ((_STEPS - 1) / FULL_STRAIN), _STEPS - 1)
    return _PALETTE[steps.astype(np.intp)]


def surface_bytes(rows: int, cols: int) -> int:
    """Return how large the points and colours of the surface are [bytes]."""
    if min(rows, cols) == 1:
        return rows * cols * _BYTES_A_CORNER
    return 6 * (min(rows, MOST_DRAWN) - 1) * (min(cols, MOST_DRAWN) - 1) * _BYTES_A_CORNER


def _sampled(count: int, limit: int) -> np.ndarray:
    return np.linspace(0, count - 1, min(count, limit)).round().astype(np.intp)


class Surface:
    """
    Which nodes are drawn, and in which order.

    :param max_side: nodes drawn along each side at most; larger cloths are sampled evenly
    :param present: which cells there are, (rows - 1, cols - 1) bool; None for all
    """

    def __init__(
            self, rows: int, cols: int, max_side: int, present: np.ndarray | None = None) -> None:
        """Choose the nodes."""
        self.is_chain = min(rows, cols) == 1
        limit = max(rows, cols) if self.is_chain else max_side
        at_rows, at_cols = _sampled(rows, limit), _sampled(cols, limit)
        # A slice is not copied.
        self._rows = at_rows if rows > limit else slice(None)
        self._cols = at_cols if cols > limit else slice(None)
        corners = triangles(
            len(at_rows), len(at_cols),
            None if present is None else sampled_cells(present, at_rows, at_cols))
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
