# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What colliders do to the energy of a cloth: the work of those that move, and compression."""

from collections.abc import Sequence
from itertools import combinations

from cloth_sim_ros.sim.colliders import Collider
from cloth_sim_ros.sim.contacts import ContactForce
from cloth_sim_ros.sim.pose import rotation_between
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Of the cosine between two normals: surfaces below it face each other, as in contact.glsl.
_FACING = -0.9
# Of a derivative [m].
_STEP = 1e-5


def contact_work(
        forces: Sequence[ContactForce], before: Sequence[Collider],
        after: Sequence[Collider]) -> float:
    """
    Return the work that colliders have done on the cloth in a step of dt [J].

    :param forces: on the colliders, the mean over the step
    :param before: the colliders as it began
    :param after: as it ended
    """
    work = 0.0
    for force, first, last in zip(forces, before, after):
        axis, angle = rotation_between(first.orientation, last.orientation)
        way = np.array(last.position) - np.array(first.position)
        work -= float(force.force @ way + angle * (force.torque @ axis))
    return work


def compression_energy(
        scene: Scene, colliders: Sequence[Collider], positions: np.ndarray) -> float:
    """
    Return the energy [J] of cloth that colliders facing each other compress.

    :param positions: (rows, cols, 3) [m]
    """
    thickness = scene['contact.thickness']
    gaps = [body.distance(positions) - 0.5 * thickness for body in colliders]
    compressed = 0.0
    for first, second in combinations(range(len(colliders)), 2):
        lacking = np.maximum(-(gaps[first] + gaps[second]), 0.0)
        if not lacking.any():
            continue
        normals = [_normals(colliders[number], positions) for number in (first, second)]
        lacking = lacking[np.sum(normals[0] * normals[1], axis=-1) < _FACING]
        # The pressure grows up to a whole thickness, and no further.
        growing = np.minimum(lacking, thickness)
        linear = 0.5 * growing**2 / thickness if thickness > 0.0 else 0.0
        compressed += float(np.sum(linear + lacking - growing))
    area = scene['width'] * scene['height'] / scene.node_count
    return float(scene['contact.compression']) * area * compressed


def _normals(body: Collider, positions: np.ndarray) -> np.ndarray:
    """Return the directions in which the distance from ``body`` grows, (..., 3)."""
    slopes = np.stack([
        body.distance(positions + way) - body.distance(positions - way)
        for way in _STEP * np.eye(3)], axis=-1)
    return slopes / np.maximum(np.linalg.norm(slopes, axis=-1, keepdims=True), 1e-30)
