# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The surface of a cloth as triangles between its nodes."""

from dataclasses import dataclass

from cloth_sim_ros.sim.model.cells import present_nodes
import numpy as np


@dataclass(frozen=True, eq=False)
class Mesh:
    """
    The surface of a cloth at one time.

    Its vertices are the nodes along the rows, without those that a shape cuts away.

    :param vertices: positions [m], (n, 3) float32
    :param normals: unit normals, up for a cloth that lies flat, (n, 3) float32
    :param uv: texture coordinates, (n, 2) float32: u from 0 in the first column to 1 in the last,
        v from 0 in the last row to 1 in the first. They are those of the rectangle of width x
        height that a shape is cut from, so multiply by these for metres
    :param triangles: the vertices of each, counter-clockwise seen from where the normals point,
        (m, 3) int32; two for each cell, none for a chain
    """

    vertices: np.ndarray
    normals: np.ndarray
    uv: np.ndarray
    triangles: np.ndarray


def triangles(rows: int, cols: int, present: np.ndarray | None = None) -> np.ndarray:
    """
    Return the nodes of the two triangles of each cell, counted along the rows.

    Counter-clockwise seen from above while the cloth lies flat; none for a chain.

    :param present: which cells there are, (rows - 1, cols - 1) bool; None for all
    :return: (2 cells, 3) uint32
    """
    node = np.arange(rows * cols, dtype='<u4').reshape(rows, cols)
    corners = (
        node[:-1, :-1], node[1:, :-1], node[:-1, 1:],
        node[:-1, 1:], node[1:, :-1], node[1:, 1:])
    each = np.stack(corners, axis=-1)
    return (each if present is None else each[present]).reshape(-1, 3)


def sampled_cells(present: np.ndarray, rows: np.ndarray, cols: np.ndarray) -> np.ndarray:
    """
    Return which cells there are between some nodes of a lattice.

    A cell of these is there with its four corners, and where there is cloth in its middle.

    :param present: cells of the whole lattice, (rows - 1, cols - 1) bool
    :param rows: of the nodes, (n,)
    :param cols: of the nodes, (m,)
    :return: (n - 1, m - 1) bool
    """
    nodes = present_nodes(present)[np.ix_(rows, cols)]
    middle = present[np.ix_((rows[:-1] + rows[1:]) // 2, (cols[:-1] + cols[1:]) // 2)]
    return middle & nodes[:-1, :-1] & nodes[:-1, 1:] & nodes[1:, :-1] & nodes[1:, 1:]


def mesh_of_nodes(positions: np.ndarray, normals: np.ndarray, present: np.ndarray) -> Mesh:
    """
    Return the mesh of the nodes of a lattice.

    :param positions: [m], (rows, cols, 3)
    :param normals: unit normals, (rows, cols, 3)
    :param present: which cells there are, (rows - 1, cols - 1) bool
    """
    rows, cols = positions.shape[:2]
    corners = triangles(rows, cols, None if present.all() else present)
    # A chain has nodes, and no cell that they could be of.
    used = np.full(rows * cols, min(rows, cols) == 1)
    used[corners] = True
    u, v = np.meshgrid(np.linspace(0.0, 1.0, cols), np.linspace(1.0, 0.0, rows))
    with np.errstate(over='ignore'):  # float64 of other programs becomes infinite
        vertices, directions, places = (
            values.reshape(rows * cols, -1)[used].astype(np.float32)
            for values in (positions, normals, np.stack([u, v], axis=-1)))
    numbers = np.cumsum(used, dtype=np.int32) - np.int32(1)
    return Mesh(vertices, directions, places, numbers[corners])
