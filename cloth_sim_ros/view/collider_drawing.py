# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What the cloth can touch, in the scene of a page."""

from cloth_sim_ros.analysis.collider_surface import local_surface
from cloth_sim_ros.messages.geometry import triangles
from cloth_sim_ros.sim.colliders import Collider
import numpy as np
import viser

COLOR = (140, 148, 158)
# How far a plane is shown from its origin, in diagonals of the cloth.
_PLANE = 3.0


class ColliderDrawing:
    """A mesh for each collider, which moves with it."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Begin without colliders."""
        self._scene = server.scene
        self._handles: dict[str, viser.MeshHandle] = {}
        self._shown: tuple[Collider, ...] = ()

    def draw(self, colliders: tuple[Collider, ...], positions: np.ndarray) -> None:
        """
        Show ``colliders`` where they are.

        :param positions: of the cloth, which the size of planes is chosen by, (rows, cols, 3) [m]
        """
        if colliders == self._shown:
            return
        self._shown = colliders
        names = {collider.name for collider in colliders}
        for name in self._handles.keys() - names:
            self._handles.pop(name).remove()
        for collider in colliders:
            if collider.name not in self._handles:
                self._handles[collider.name] = self._add(collider, positions)
            handle = self._handles[collider.name]
            x, y, z, w = collider.orientation
            handle.position, handle.wxyz = np.array(collider.position), np.array((w, x, y, z))

    def _add(self, collider: Collider, positions: np.ndarray) -> viser.MeshHandle:
        size = float(np.linalg.norm(np.ptp(positions.reshape(-1, 3), axis=0)))
        points, _ = local_surface(collider.shape, collider.size, _PLANE * size)
        return self._scene.add_mesh_simple(
            f'/colliders/{collider.name}', points.reshape(-1, 3).astype(np.float32),
            triangles(*points.shape[:2]), color=COLOR)
