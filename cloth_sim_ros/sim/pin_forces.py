# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The forces that hold the pinned nodes, by the tension of the edges."""

from dataclasses import dataclass

from cloth_sim_ros.sim.bending import bending_pulls
from cloth_sim_ros.sim.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# As in spring_law.glsl: two nodes in one place are this far apart [m].
_LEAST_LENGTH = 1e-10


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
    for kind in EDGE_KINDS:
        if not scene.models(kind.family):
            continue
        starts, ends = (
            kind.everywhere(scene.rows, scene.cols) if nodes is None
            else kind.touching(nodes, scene.rows, scene.cols))
        d = positions[ends].astype(float) - positions[starts]
        length = np.maximum(np.linalg.norm(d, axis=-1), _LEAST_LENGTH)
        rest = kind.rest_length(scene)
        stretch = length - rest
        pull = kind.stiffness(scene) * stretch
        if kind.damping(scene) > 0.0:
            dv = velocities[ends].astype(float) - velocities[starts]
            pull += kind.damping(scene) * np.sum(dv * d, axis=-1) / length
        tension[(*starts, kind.number)] = pull
    return tension


@dataclass(frozen=True)
class PinForces:
    """
    The reaction force at each pinned node, row by row.

    :param nodes: its row and column, (pins, 2) int
    :param forces: the force on the cloth [N], (pins, 3) float64; a gripper feels the opposite
    """

    nodes: np.ndarray
    forces: np.ndarray


def pin_forces(
        scene: Scene, positions: np.ndarray, tension: np.ndarray, nodes: np.ndarray,
        accelerations: np.ndarray | None = None, loads: np.ndarray | None = None,
        velocities: np.ndarray | None = None) -> PinForces:
    """
    Return R = m (a - g) - (what edges and bending pull a node with) for each of ``nodes``.

    Other loads count with gravity.

    The work grows with the nodes given, not with the cloth.

    :param positions: (rows, cols, 3) [m]
    :param tension: of every edge with an end in ``nodes`` [N], (rows, cols, 6) as in Snapshot
    :param nodes: rows and columns of the pinned nodes, (pins, 2) int
    :param accelerations: of the pinned nodes [m/s2], (pins, 3); by default they hold still
    :param loads: what accelerates them, gravity too [m/s2], (pins, 3); gravity alone by default
    :param velocities: (rows, cols, 3) [m/s], which damp bending; by default, the cloth is at rest
    """
    applied = np.array(scene['gravity']) if loads is None else loads
    own = -applied if accelerations is None else accelerations - applied
    return PinForces(
        nodes,
        scene.node_mass * own - edge_pulls(scene, positions, velocities, tension, nodes))


def edge_pulls(
        scene: Scene, positions: np.ndarray, velocities: np.ndarray | None,
        tension: np.ndarray, nodes: np.ndarray) -> np.ndarray:
    """Return what edges and bending pull each of ``nodes`` with [N], (n, 3); as in pin_forces."""
    pulls = (
        bending_pulls(scene, positions, velocities, nodes) if scene.has_rigidity
        else np.zeros((len(nodes), 3)))
    here = positions[tuple(nodes.T)].astype(float)
    for kind in EDGE_KINDS:
        offset = np.array((kind.drow, kind.dcol))
        for starts, others in ((nodes, nodes + offset), (nodes - offset, nodes - offset)):
            there = kind.starting_at(starts, scene.rows, scene.cols)
            d = positions[tuple(others[there].T)] - here[there]
            length = np.linalg.norm(d, axis=-1)
            # An edge of no length has no direction: it pulls nowhere.
            pull = np.divide(
                tension[(*starts[there].T, kind.number)], length,
                out=np.zeros_like(length), where=length > 0.0)
            pulls[there] += pull[:, None] * d
    return pulls
