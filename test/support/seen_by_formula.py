# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a pinhole camera sees, by float64 formulas alone: rays, triangles, spheres and planes."""

import numpy as np


def rays_of(camera, offset=0.5):
    """Return the rays of all pixels per metre of depth, in the optical frame, (n, 3)."""
    v, u = np.indices((camera.height, camera.width)) + (offset - 0.5)
    return np.stack([
        (u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones_like(u)],
        axis=-1).reshape(-1, 3)


def triangles_of(positions):
    """Return the corners of the triangles of a cloth, (n, 3, 3)."""
    a, b = positions[:-1, :-1], positions[:-1, 1:]
    c, d = positions[1:, :-1], positions[1:, 1:]
    return np.concatenate([
        np.stack([a, c, b], axis=-2).reshape(-1, 3, 3),
        np.stack([b, c, d], axis=-2).reshape(-1, 3, 3)])


def meet_triangles(rays, triangles, edge=0.0):
    """
    Return the depth at which rays from the origin first meet triangles; inf for none.

    :param edge: how far outside of a triangle still counts, in barycentric coordinates
    """
    nearest = np.full(len(rays), np.inf)
    for corner, first, second in triangles:
        normal = np.cross(first - corner, second - corner)
        along = rays @ normal
        with np.errstate(divide='ignore', invalid='ignore'):
            depth = (corner @ normal) / along
            places = depth[:, None] * rays - corner
            square = normal @ normal
            u = np.cross(places, second - corner) @ normal / square
            v = np.cross(first - corner, places) @ normal / square
            hit = (u >= -edge) & (v >= -edge) & (u + v <= 1.0 + edge) & (depth > 0.0)
        nearest = np.where(hit & (depth < nearest), depth, nearest)
    return nearest


def meet_sphere(rays, middle, radius):
    """Return the depth at which rays from the origin enter a sphere; inf for none."""
    square = (rays ** 2).sum(axis=-1)
    next_to = rays @ middle / square
    aside = ((next_to[:, None] * rays - middle) ** 2).sum(axis=-1)
    inside = aside < radius ** 2
    depth = next_to - np.sqrt(np.where(inside, radius ** 2 - aside, 0.0) / square)
    return np.where(inside & (depth > 0.0), depth, np.inf)


def meet_plane(rays, point, normal):
    """Return the depth at which rays from the origin meet a plane from above; inf for none."""
    with np.errstate(divide='ignore', invalid='ignore'):
        depth = (point @ normal) / (rays @ normal)
    return np.where((rays @ normal < 0.0) & (depth > 0.0), depth, np.inf)
