# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
How the shape of a drape from two corners depends on the grid, by Newton's method in float64.

The equilibria of the springs and the bending of a fabric, without a simulation, which would take
hours on the fine grids to come to rest as accurately. Lengths are over the side, forces over the
weight. For example:
  python benchmarks/drape_at_rest.py --nodes 13 25 49 97 --load 13 --stiffness 1e6
"""

from argparse import ArgumentParser
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.interpolate import RectBivariateSpline
from scipy.optimize import brentq
from scipy.sparse.linalg import splu

# Residual force at rest, over the weight [1].
_TOLERANCE = 1e-7
# Largest move of a node in an iteration [sides].
_LONGEST_MOVE = 0.05
_MOST_ITERATIONS = 400
# Stiffness that makes matrices regular, over that of the edges [1].
_REGULAR = 1e-9


@dataclass(frozen=True)
class Drape:
    """
    A square fabric that hangs from its upper corners, of side 1 and weight 1.

    :param load: w L^3 / B, weight over rigidity
    :param stiffness: K L^2 / B, stiffness to stretch over rigidity
    :param shear: shear stiffness over that to stretch
    :param apart: distance of the corners over the side
    :param patch: side of the patch that is held at each corner, 0 for the corner's node
    :param pull: strain of an edge that carries the weight, for hard edges instead of the fabric's
    """

    load: float
    stiffness: float
    shear: float = 1.0 / 3.0
    apart: float = 0.9
    patch: float = 0.0
    pull: float = 0.0

    def start(self, nodes: int) -> np.ndarray:
        """Return a bow of a cylinder, (nodes, nodes, 3)."""
        turn = brentq(lambda angle: np.sin(angle) / angle - self.apart, 1e-3, np.pi)
        angles = np.linspace(-turn, turn, nodes)
        positions = np.zeros((nodes, nodes, 3))
        positions[..., 0] = 0.5 / turn * np.sin(angles)
        positions[..., 1] = 0.5 / turn * (np.cos(angles) - np.cos(turn))
        positions[..., 2] = -np.linspace(0.0, 1.0, nodes)[:, np.newaxis]
        return positions

    def held(self, nodes: int) -> np.ndarray:
        """Return which nodes are, (nodes, nodes) bool."""
        places = np.linspace(0.0, 1.0, nodes)
        near = places <= self.patch + 1e-9
        return near[:, np.newaxis] & (near | near[::-1])


class Lattice:
    """Edges and lines of bending of a drape on a grid."""

    def __init__(self, drape: Drape, nodes: int) -> None:
        """Count whatever lies at a border by half."""
        number = np.arange(nodes * nodes).reshape(nodes, nodes)
        half = np.ones(nodes)
        half[[0, -1]] = 0.5
        spacing = 1.0 / (nodes - 1)
        rigidity = 1.0 / drape.load
        shear = drape.shear * drape.stiffness * rigidity
        straight = drape.stiffness * rigidity - shear
        across = np.broadcast_to(half[:, np.newaxis], (nodes, nodes - 1))
        whole = np.ones((nodes - 1, nodes - 1))
        kinds = (
            (number[:, :-1], number[:, 1:], straight * across, 1.0, across),
            (number[:-1], number[1:], straight * across.T, 1.0, across.T),
            (number[:-1, :-1], number[1:, 1:], shear * whole, np.sqrt(2.0), whole),
            (number[:-1, 1:], number[1:, :-1], shear * whole, np.sqrt(2.0), whole))
        self.length = np.concatenate([np.full(kind[0].size, spacing * kind[3]) for kind in kinds])
        self.stiffness = np.concatenate([kind[2].ravel() for kind in kinds])
        if drape.pull:
            # As sim/solver/edge_law.py has it.
            share = np.concatenate([kind[4].ravel() for kind in kinds])
            pull = max(1.0, 1.0 / (0.03 * nodes)) / drape.pull
            self.stiffness = share * pull / self.length
        self.difference = _rows_of(nodes**2, [
            (-1.0, np.concatenate([kind[0].ravel() for kind in kinds])),
            (1.0, np.concatenate([kind[1].ravel() for kind in kinds]))])
        second = _rows_of(nodes**2, [
            (weight, np.concatenate([
                number[:, at:nodes - 2 + at].ravel(), number[at:nodes - 2 + at].ravel()]))
            for at, weight in enumerate((1.0, -2.0, 1.0))])
        lines = np.concatenate([across[:, 1:].ravel(), across.T[1:].ravel()])
        self.bending = (
            second.T @ sparse.diags(rigidity / spacing**2 * lines) @ second).tocsr()
        self.weight = np.zeros((nodes**2, 3))
        self.weight[:, 2] = -spacing**2 * np.outer(half, half).ravel()
        self.difference_3 = sparse.kron(self.difference, sparse.eye(3), format='csr')
        self.bending_3 = sparse.kron(self.bending, sparse.eye(3), format='csr')

    def energy(self, positions: np.ndarray) -> float:
        """Return that of edges, bending and weight."""
        stretch = np.linalg.norm(self.difference @ positions, axis=1) - self.length
        return float(
            0.5 * np.sum(self.stiffness * stretch**2) - np.sum(self.weight * positions)
            + 0.5 * np.sum(positions * (self.bending @ positions)))

    def forces(self, positions: np.ndarray) -> np.ndarray:
        """Return the force on each node, (nodes, 3)."""
        edges = self.difference @ positions
        lengths = np.linalg.norm(edges, axis=1)
        pull = self.stiffness * (lengths - self.length) / lengths
        return self.weight - self.bending @ positions - self.difference.T @ (
            pull[:, np.newaxis] * edges)

    def matrix(self, positions: np.ndarray, *, is_near: bool) -> sparse.csr_matrix:
        """Return the stiffness matrix, without the pressure of edges while far from rest."""
        edges = self.difference @ positions
        lengths = np.linalg.norm(edges, axis=1)
        units = edges / lengths[:, np.newaxis]
        across = self.stiffness * (1.0 - self.length / lengths)
        if not is_near:
            across = np.maximum(across, 0.0)
        outer = units[:, :, np.newaxis] * units[:, np.newaxis]
        blocks = (
            self.stiffness[:, np.newaxis, np.newaxis] * outer
            + across[:, np.newaxis, np.newaxis] * (np.eye(3) - outer))
        count = len(blocks)
        middle = sparse.bsr_matrix((blocks, np.arange(count), np.arange(count + 1)))
        return self.difference_3.T @ middle @ self.difference_3 + self.bending_3


def _rows_of(cols: int, terms: list[tuple[float, np.ndarray]]) -> sparse.csr_matrix:
    """Return a matrix with a row for each place of ``terms``, of weights at columns."""
    count = terms[0][1].size
    return sparse.csr_matrix((
        np.concatenate([np.full(count, weight) for weight, _ in terms]),
        (np.tile(np.arange(count), len(terms)), np.concatenate([at for _, at in terms]))),
        shape=(count, cols))


def rest(drape: Drape, start: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and forces on what holds them at rest, both like ``start``."""
    nodes = len(start)
    lattice = Lattice(drape, nodes)
    free = np.repeat(~drape.held(nodes).ravel(), 3)
    positions = start.reshape(-1, 3).copy()
    is_near = False
    for _ in range(_MOST_ITERATIONS):
        forces = lattice.forces(positions)
        if np.abs(forces.ravel()[free]).max() < _TOLERANCE:
            break
        matrix = lattice.matrix(positions, is_near=is_near)[free][:, free]
        matrix += _REGULAR * lattice.stiffness.max() * sparse.eye(matrix.shape[0])
        move = np.zeros(positions.size)
        move[free] = splu(
            matrix.tocsc(), permc_spec='MMD_AT_PLUS_A', diag_pivot_thresh=0.0,
            options={'SymmetricMode': True}).solve(forces.ravel()[free])
        gain = move @ forces.ravel()
        if gain < 0.0:
            is_near = False
            continue
        share = min(1.0, _LONGEST_MOVE / np.abs(move).max())
        before = lattice.energy(positions)
        while share > 1e-9 and (
                lattice.energy(positions + share * move.reshape(-1, 3))
                > before - 1e-4 * share * gain + 1e-14 * abs(before)):
            share *= 0.5
        positions += share * move.reshape(-1, 3)
        is_near = share * np.abs(move).max() < 0.2 * _LONGEST_MOVE
    else:
        raise RuntimeError(f'{nodes} nodes a side: not at rest')
    return positions.reshape(start.shape), lattice.forces(positions).reshape(start.shape)


def refined(positions: np.ndarray, nodes: int) -> np.ndarray:
    """Return positions on a finer grid, by cubic splines."""
    coarse, fine = np.linspace(0.0, 1.0, len(positions)), np.linspace(0.0, 1.0, nodes)
    return np.stack([
        RectBivariateSpline(coarse, coarse, positions[..., axis])(fine, fine)
        for axis in range(3)], axis=-1)


def figures(positions: np.ndarray, forces: np.ndarray, held: np.ndarray) -> dict[str, float]:
    """Return what a user would read off a drape at rest."""
    middle = len(positions) // 2
    down = positions[0, 0, 2] - positions[..., 2]
    left = held.copy()
    left[:, middle:] = False
    return {
        'horizontal force': float(abs(forces[left][:, 0].sum())),
        'drop of the middle': float(down[middle, middle]),
        'drop of the lowest node': float(down.max()),
        'drop of the lower corners': float(down[-1, 0]),
        'depth of the bow at the top': float(positions[0, middle, 1] - positions[0, 0, 1])}


def study(drape: Drape, grids: list[int]) -> dict[str, list[float]]:
    """Return the figures of a drape on each grid."""
    found: dict[str, list[float]] = {}
    positions = None
    for nodes in grids:
        start, held = drape.start(nodes), drape.held(nodes)
        if positions is not None:
            start[~held] = refined(positions, nodes)[~held]
        positions, forces = rest(drape, start)
        for name, value in figures(positions, forces, held).items():
            found.setdefault(name, []).append(value)
    return found


def main() -> None:
    """Print the figures on each grid, and the orders in the grid."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, nargs='+', default=[13, 25, 49, 97],
                        help='nodes a side of each grid; spacings halve')
    parser.add_argument('--load', type=float, default=13.08, help='w L^3 / B')
    parser.add_argument('--stiffness', type=float, default=1e6, help='K L^2 / B')
    parser.add_argument('--apart', type=float, default=0.9, help='of the corners, over the side')
    parser.add_argument('--patch', type=float, default=0.0, help='that is held, over the side')
    parser.add_argument('--pull', type=float, default=0.0, help='constraint.strain of hard edges')
    args = parser.parse_args()
    drape = Drape(
        args.load, args.stiffness, apart=args.apart, patch=args.patch, pull=args.pull)
    for name, values in study(drape, args.nodes).items():
        steps = np.abs(np.diff(values))
        orders = ' '.join(f'{order:.2f}' for order in np.log2(steps[:-1] / steps[1:]))
        print(f'{name}: {" ".join(f"{value:.6f}" for value in values)}; order {orders}')


if __name__ == '__main__':
    main()
