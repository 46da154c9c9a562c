# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Forces of edges and bending on nodes at one moment, and on pins."""

from dataclasses import dataclass
from functools import lru_cache

from cloth_sim_ros.sim.model.cells import edge_shares
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import edges_at
from cloth_sim_ros.sim.model.edge_kinds import Index
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Bending of a cloth as of a sheet, linear in positions; see docs/explanation/numerics.md.
#
# Three nodes in a line, a apart, have the curvature D / a^2 with D = x[i-1] - 2 x[i] + x[i+1]. In
# cells of dx x dy, a sheet of the rigidity B [N m] stores c / 2 D^2 at each of them, with
# c = B dy / dx^3 along a row and B dx / dy^3 along a column. So the fourth difference of positions
# is the force, and the grid does not matter. Springs between nodes two places apart (the bend
# springs) have no such limit: on a flat cloth they do not resist at all, to first order.
#
# With damping of the time tau [s], a line resists besides by c tau times the rate at which the
# part of D across the line grows (Kelvin and Voigt). What stretches or turns it is not resisted: a
# bent cloth rotates as freely as without.

# A node's part in D of a line around the node at this place.
_PARTS = {-1: 1.0, 0: -2.0, 1: 1.0}
# Least square of a chord [m2], and of a bend, that has a direction; as in bending_damping.glsl.
_LEAST_SQUARE = 1e-20
_LEAST_BEND = 1e-30
# Least length of an edge [m], so that two nodes in one place divide by nothing; as in
# spring_law.glsl.
_LEAST_LENGTH = 1e-10


def bending_pulls(
        scene: Scene, positions: np.ndarray, velocities: np.ndarray | None,
        nodes: np.ndarray) -> np.ndarray:
    """
    Return what bending pulls ``nodes`` with [N], (n, 3) float64.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]; None for a cloth at rest
    :param nodes: rows and columns, (n, 2) int
    """
    pulls = np.zeros((len(nodes), 3))
    moving = velocities if scene.has_bending_damping else None
    for direction, (c, by) in enumerate(zip(scene.bending, ((0, 1), (1, 0)))):
        for place, part in _PARTS.items():
            centres = nodes + np.array(by) * place
            lines = np.stack([centres - by, centres, centres + by])
            are_there = np.all((lines >= 0) & (lines < (scene.rows, scene.cols)), axis=(0, 2))
            weights: float | np.ndarray = c
            if scene.cells is not None:
                middles = centres[are_there]
                shares = scene.cells.line_shares_at((middles[:, 0], middles[:, 1]), direction)
                weights = c * shares[:, None]
            behind, here, ahead = (
                positions[tuple(line[are_there].T)].astype(float) for line in lines)
            bent = (behind - here) + (ahead - here)
            pulls[are_there] -= weights * part * bent
            if moving is not None:
                # The node stands at the other side of the line's middle.
                pulls[are_there] -= scene['bending.damping'] * weights * _brake(
                    bent, ahead - behind,
                    [moving[tuple(line[are_there].T)].astype(float) for line in lines],
                    part, -place)
    return pulls


def _brake(
        bent: np.ndarray, chord: np.ndarray, velocities: list[np.ndarray], part: float,
        place: int) -> np.ndarray:
    """Return what lines resist at one of their nodes, over c tau, as bending_damping.glsl does."""
    behind, here, ahead = velocities
    skew = np.sum(bent * chord, axis=1, keepdims=True) / np.maximum(
        np.sum(chord**2, axis=1, keepdims=True), _LEAST_SQUARE)
    across = bent - skew * chord
    square = np.maximum(np.sum(across**2, axis=1, keepdims=True), _LEAST_BEND)
    across /= np.sqrt(square * (1.0 + skew**2 / 3.0))
    grown = (behind - here) + (ahead - here) - skew * (ahead - behind)
    speed = np.sum(across * grown, axis=1, keepdims=True)
    return (part - place * skew) * speed * across


# What edges pull nodes with, by their tension.

def filled(scene: Scene, vectors: np.ndarray) -> np.ndarray:
    """Return ``vectors``, (rows, cols, 3), with 0 instead of NaN where a shape has no node."""
    return np.where(scene.present_nodes[..., None], vectors, 0.0) if scene.has_gaps else vectors


def spring_tension(
        scene: Scene, positions: np.ndarray, velocities: np.ndarray,
        nodes: np.ndarray | None = None) -> np.ndarray:
    """
    Return k (l - L0) + k_d dl/dt of every spring [N], (rows, cols, 6) float32; above 0 it pulls.

    It is as exact as the positions are: some 1e-7 of k times a coordinate.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s]
    :param nodes: (n, 2) rows and columns, for the springs at these nodes alone: the others are 0
    """
    tension = np.zeros((scene.rows, scene.cols, len(EDGE_KINDS)), dtype=np.float32)
    positions, velocities = filled(scene, positions), filled(scene, velocities)
    if nodes is not None:
        # All kinds at once: these edges are few, and each call of NumPy costs more than they do.
        edges = edges_at(nodes, scene.rows, scene.cols)
        starts, ends = (edges.starts[0], edges.starts[1]), (edges.ends[0], edges.ends[1])
        pull = _pull(positions, velocities, starts, ends, *_springs(scene)[:, edges.kinds])
        if scene.cells is not None:
            pull *= scene.cells.edge_shares_at(starts, edges.kinds)
        tension[(*starts, edges.kinds)] = pull
        return tension
    for kind in EDGE_KINDS:
        if not scene.models(kind.family):
            continue
        starts, ends = kind.everywhere(scene.rows, scene.cols)
        tension[(*starts, kind.number)] = edge_shares(scene.cells, kind) * _pull(
            positions, velocities, starts, ends, kind.rest_length(scene), kind.stiffness(scene),
            kind.damping(scene))
    return tension


@lru_cache(maxsize=8)
def _springs(scene: Scene) -> np.ndarray:
    """Return rest length, stiffness and damping of each kind, (3, 6); 0 where there are none."""
    return np.array([
        (kind.rest_length(scene), kind.stiffness(scene), kind.damping(scene))
        if scene.models(kind.family) else (0.0, 0.0, 0.0) for kind in EDGE_KINDS]).T


def _pull(
        positions: np.ndarray, velocities: np.ndarray, starts: Index, ends: Index,
        rest: float | np.ndarray, stiffness: float | np.ndarray,
        damping: float | np.ndarray) -> np.ndarray:
    """Return what springs from ``starts`` to ``ends`` pull with [N], of the shape of these."""
    d = positions[ends].astype(float) - positions[starts]
    length = np.maximum(np.linalg.norm(d, axis=-1), _LEAST_LENGTH)
    pull = stiffness * (length - rest)
    if np.any(damping):
        dv = velocities[ends].astype(float) - velocities[starts]
        pull += damping * np.sum(dv * d, axis=-1) / length
    return pull


@dataclass(frozen=True)
class PinForces:
    """
    The force of the cloth on what holds each pinned node, row by row.

    :param nodes: its row and column, (pins, 2) int
    :param forces: the mean over the last step of dt, or over a frame [N], (pins, 3) float64
    :param peaks: the force in the substep in which it was strongest [N], (pins, 3) float64
    """

    nodes: np.ndarray
    forces: np.ndarray
    peaks: np.ndarray


def edge_pulls(
        scene: Scene, positions: np.ndarray, velocities: np.ndarray | None,
        tension: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """
    Return what edges and bending pull each of ``nodes`` with at this moment [N], (n, 3).

    The work grows with the nodes given, not with the cloth.

    :param positions: (rows, cols, 3) [m]
    :param velocities: (rows, cols, 3) [m/s], which damp bending; None for a cloth at rest
    :param tension: of every edge with an end in ``nodes`` [N], (rows, cols, 6) as in Snapshot
    :param nodes: rows and columns, (n, 2) int
    """
    positions = filled(scene, positions)
    velocities = None if velocities is None else filled(scene, velocities)
    pulls = (
        bending_pulls(scene, positions, velocities, nodes) if scene.has_rigidity
        else np.zeros((len(nodes), 3)))
    here = positions[tuple(nodes.T)].astype(float)
    edges = edges_at(nodes, scene.rows, scene.cols)
    d = positions[tuple(edges.others)] - here[edges.nodes]
    length = np.linalg.norm(d, axis=-1)
    # An edge of no length has no direction: it pulls nowhere.
    pull = np.divide(
        tension[(*edges.starts, edges.kinds)], length, out=np.zeros_like(length),
        where=length > 0.0)
    np.add.at(pulls, edges.nodes, pull[:, None] * d)
    return pulls
