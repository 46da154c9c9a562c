# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Bending of a cloth as of a sheet, linear in positions; see docs/explanation/numerics.md.

Three nodes in a line, a apart, have the curvature D / a^2 with D = x[i-1] - 2 x[i] + x[i+1]. In
cells of dx x dy, a sheet of the rigidity B [N m] stores c / 2 D^2 at each of them, with
c = B dy / dx^3 along a row and B dx / dy^3 along a column. So the fourth difference of positions
is the force, and the grid does not matter. Springs between nodes two places apart (the bend
springs) have no such limit: on a flat cloth they do not resist at all, to first order.

With damping of the time tau [s], a line resists besides by c tau times the rate at which the part
of D across the line grows (Kelvin and Voigt). What stretches or turns it is not resisted: a bent
cloth rotates as freely as without.
"""

from cloth_sim_ros.sim.scene import Scene
import numpy as np

# A node's part in D of a line around the node at this place.
_PARTS = {-1: 1.0, 0: -2.0, 1: 1.0}
# Squares of a chord and of a bend [m2], as in bending_damping.glsl: below, none has a direction.
_LEAST_SQUARE, _LEAST_BEND = 1e-20, 1e-30


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
    for c, by in zip(scene.bending, ((0, 1), (1, 0))):
        for place, part in _PARTS.items():
            centres = nodes + np.array(by) * place
            lines = np.stack([centres - by, centres, centres + by])
            are_there = np.all((lines >= 0) & (lines < (scene.rows, scene.cols)), axis=(0, 2))
            behind, here, ahead = (
                positions[tuple(line[are_there].T)].astype(float) for line in lines)
            bent = (behind - here) + (ahead - here)
            pulls[are_there] -= c * part * bent
            if moving is not None:
                # The node stands at the other side of the line's middle.
                pulls[are_there] -= scene['bending.damping'] * c * _brake(
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
