# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far points are from a collider, by formulas that share nothing with the shaders."""

from cloth_sim_ros.sim.model.colliders import Collider
import numpy as np
from scipy.spatial.transform import Rotation


def distance_to(body: Collider, points: np.ndarray) -> np.ndarray:
    """
    Return the distances of ``points`` (..., 3) from the surface of ``body``, negative inside [m].

    Boxes and cylinders have their exact distance outside, and that of the nearest side inside.
    """
    shape = points.shape[:-1]
    turned = Rotation.from_quat(body.orientation).inv().apply(
        points.reshape(-1, 3).astype(float) - np.array(body.position))
    return _distance(body.shape, body.size, turned).reshape(shape)


def _distance(shape: str, size: tuple[float, ...], p: np.ndarray) -> np.ndarray:
    if shape == 'plane':
        return p[:, 2]
    if shape == 'box':
        return _to_corner(np.abs(p) - np.array(size) / 2.0)
    if shape == 'cylinder':
        return _to_corner(np.stack(
            [np.hypot(p[:, 0], p[:, 1]) - size[0], np.abs(p[:, 2]) - size[1] / 2.0], axis=-1))
    core = np.zeros_like(p)
    if shape == 'capsule':
        core[:, 2] = np.clip(p[:, 2], -size[1] / 2.0, size[1] / 2.0)
    return np.linalg.norm(p - core, axis=-1) - size[0]


def _to_corner(q: np.ndarray) -> np.ndarray:
    return np.linalg.norm(np.maximum(q, 0.0), axis=-1) + np.minimum(q.max(axis=-1), 0.0)
