# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth as triangles in a few colours of strain, and where a ray meets it."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.analysis.strain_stops import strain_rgb
from cloth_sim_ros.sim.mesh import sampled_cells
from cloth_sim_ros.sim.mesh import triangles
import numpy as np

BANDS = 12
MOST_NODES = 128  # along a side

# Vertices (n, 3) float32 [m] and faces (m, 3) uint32.
Mesh = tuple[np.ndarray, np.ndarray]


class Surface:
    """
    The shown nodes of a lattice.

    :param rows: of the cloth
    :param cols: of the cloth
    :param cells: which there are, (rows - 1, cols - 1) bool; None for all
    """

    def __init__(self, rows: int, cols: int, cells: np.ndarray | None = None) -> None:
        """Choose the nodes to show: all, or some of each row and column, with the last."""
        self.rows = _thinned(rows)
        self.cols = _thinned(cols)
        self.cells = np.ones((rows - 1, cols - 1), dtype=bool) if cells is None else cells
        self.faces = triangles(
            len(self.rows), len(self.cols), sampled_cells(self.cells, self.rows, self.cols))

    def points(self, frame: Frame) -> np.ndarray:
        """Return the shown nodes [m], (nodes, 3) float32; NaN where there is none."""
        return self._shown(frame.positions).reshape(-1, 3).astype(np.float32)

    def strain(self, frame: Frame) -> np.ndarray:
        """Return the strain at the shown nodes, (nodes,)."""
        return self._shown(frame.strain).ravel()

    def node(self, number: int) -> tuple[int, int]:
        """Return row and column in the cloth of a shown node."""
        row, col = divmod(number, len(self.cols))
        return int(self.rows[row]), int(self.cols[col])

    def bands(self, frame: Frame, full_strain: float) -> list[Mesh | None]:
        """
        Return the triangles of each band of strain; None for a band without any.

        :param full_strain: at which the last band begins to stand for all that is above
        """
        points = self.points(frame)
        strain = self.strain(frame)[self.faces].mean(axis=1)
        # NaN is drawn in the last colour.
        band = np.fmin(np.nan_to_num(strain / full_strain, nan=1.0) * BANDS, BANDS - 1)
        band = band.astype(int)
        meshes: list[Mesh | None] = []
        for number in range(BANDS):
            used, faces = np.unique(self.faces[band == number], return_inverse=True)
            meshes.append(
                (points[used], faces.reshape(-1, 3).astype(np.uint32)) if len(used) else None)
        return meshes

    def _shown(self, values: np.ndarray) -> np.ndarray:
        return values[np.ix_(self.rows, self.cols)]


def band_colors() -> list[tuple[int, int, int]]:
    """Return red, green and blue from 0 to 255 of each band, as pictures have them."""
    return [tuple(color) for color in strain_rgb((np.arange(BANDS) + 0.5) / BANDS).tolist()]


def _thinned(count: int) -> np.ndarray:
    shown = min(count, MOST_NODES)
    return np.linspace(0.0, count - 1, shown).round().astype(int)


@dataclass(frozen=True)
class Hit:
    """
    A point of the cloth, and the node that is nearest to it.

    :param point: x y z [m]
    :param node: its number, counted along the rows
    """

    point: tuple[float, float, float]
    node: int


def first_hit(
        origin: Sequence[float], direction: Sequence[float], points: np.ndarray,
        faces: np.ndarray) -> Hit | None:
    """
    Return where the ray first meets a triangle, from either side; None where it meets none.

    T. Moeller, B. Trumbore, Fast, minimum storage ray/triangle intersection, Journal of Graphics
    Tools 2(1), 1997.

    :param origin: (3,) [m]
    :param direction: (3,), of any length
    :param points: (nodes, 3) [m]
    :param faces: (triangles, 3) numbers of nodes
    """
    start, along = np.asarray(origin, float), np.asarray(direction, float)
    corners = points[faces].astype(float)
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    across = np.cross(along, second)
    determinant = np.einsum('ti,ti->t', first, across)
    away = start - corners[:, 0]
    turned = np.cross(away, first)
    with np.errstate(divide='ignore', invalid='ignore'):
        u = np.einsum('ti,ti->t', away, across) / determinant
        v = np.einsum('i,ti->t', along, turned) / determinant
        distance = np.einsum('ti,ti->t', second, turned) / determinant
        meets = (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (distance > 0.0)
    if not meets.any():
        return None
    triangle = int(np.argmin(np.where(meets, distance, np.inf)))
    point = start + distance[triangle] * along
    nearest = np.argmin(np.linalg.norm(corners[triangle] - point, axis=-1))
    return Hit(tuple(point.tolist()), int(faces[triangle, nearest]))
