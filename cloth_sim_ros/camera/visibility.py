# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which nodes of a cloth a camera sees."""

from cloth_sim_ros.sim.model.cameras import CameraModel
import numpy as np

# A node is hidden by what is nearer by more than this share of its depth [1]: ten roundings of
# float32, of the depth and of the plane that it is extended by.
_ROUNDING = 1e-5
# A facet that is seen from its edge tells no depth beside its pixel: least cosine [1].
_LEAST_COSINE = 1e-3


def visible_nodes(
        seen: np.ndarray, depth: np.ndarray, facets: np.ndarray,
        camera: CameraModel) -> np.ndarray:
    """
    Return which nodes are in the picture and not hidden, (rows, cols) bool.

    A node lies between the middles of four pixels. It is seen if the surface in one of them,
    extended as a plane to the node, is not in front of it.

    :param seen: nodes in the optical frame, (rows, cols, 3) [m]; NaN where there is none
    :param depth: of each pixel [m], (height, width)
    :param facets: normal n and offset d of the plane n . X = d of each pixel, (height, width, 4)
    """
    z = seen[..., 2]
    with np.errstate(invalid='ignore'):
        is_near = (z >= camera.near) & (z <= camera.far)
        pixels = camera.project(seen)
        inside = is_near & (pixels > -0.5).all(axis=-1) & (
            pixels < (camera.width - 0.5, camera.height - 0.5)).all(axis=-1)
    found = np.zeros(z.shape, bool)
    places = np.nonzero(inside)
    at, there = pixels[places], z[places]
    rays = seen[places] / there[:, None]
    is_seen = np.zeros(len(there), bool)
    corner = np.floor(at).astype(int)
    for right, down in ((0, 0), (1, 0), (0, 1), (1, 1)):
        u = np.clip(corner[:, 0] + right, 0, camera.width - 1)
        v = np.clip(corner[:, 1] + down, 0, camera.height - 1)
        normal, offset = facets[v, u, :3], facets[v, u, 3]
        cosine = (normal * rays).sum(axis=-1)
        with np.errstate(invalid='ignore', divide='ignore'):
            extended = np.where(
                np.abs(cosine) > _LEAST_COSINE, offset / cosine, depth[v, u])
        # Where nothing is, nothing hides the node.
        surface = np.where(np.isfinite(depth[v, u]), extended, depth[v, u])
        is_seen |= there <= surface * (1.0 + _ROUNDING)
    found[places] = is_seen
    return found
