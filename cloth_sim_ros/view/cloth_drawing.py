# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth and its pins in the scene of a page."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.messages.geometry import FULL_STRAIN
from cloth_sim_ros.messages.geometry import strain_colors
from cloth_sim_ros.view.surface import band_colors
from cloth_sim_ros.view.surface import Surface
import numpy as np
import viser

_PIN_COLOR = (220, 40, 40)
# Of the diagonal of the cloth.
_PIN_SIZE = 0.012
# Props of a mesh that shows nothing: viser takes no empty one.
_NO_VERTICES = np.zeros((3, 3), np.float32)
_NO_FACES = np.array([[0, 1, 2]], np.uint32)


class ClothDrawing:
    """A mesh for each band of strain, and a dot for each pin; a chain of nodes has dots alone."""

    def __init__(self, server: viser.ViserServer) -> None:
        """Add the bands, without triangles."""
        self._scene = server.scene
        self.surface = Surface(1, 2)
        self.full_strain = 0.0
        self._shape: tuple[int, int] = (0, 0)
        self._size = 0.0
        self._bands = [
            self._scene.add_mesh_simple(
                f'/cloth/strain_{band}', _NO_VERTICES, _NO_FACES, color=color, side='double',
                visible=False)
            for band, color in enumerate(band_colors())]

    def draw(self, frame: Frame, full_strain: float) -> None:
        """
        Show the cloth as it is in ``frame``.

        :param full_strain: that the last colour stands for
        """
        if frame.strain.shape != self._shape:
            self._shape = frame.strain.shape
            self.surface = Surface(*self._shape)
            points = self.surface.points(frame)
            self._size = _PIN_SIZE * float(np.linalg.norm(np.ptp(points, axis=0)))
        self.full_strain = full_strain
        for handle, mesh in zip(self._bands, self.surface.bands(frame, full_strain)):
            handle.visible = mesh is not None
            if mesh is not None:
                handle.vertices, handle.faces = mesh
        if not len(self.surface.faces):
            strain = self.surface.strain(frame) * (FULL_STRAIN / full_strain)
            colors = (255 * strain_colors(strain)[:, :3]).astype(np.uint8)
            self._add_dots('/cloth/nodes', self.surface.points(frame), colors)
        pins = frame.positions[frame.pinned].astype(np.float32)
        self._add_dots('/cloth/pins', pins, _PIN_COLOR)

    def _add_dots(
            self, name: str, points: np.ndarray,
            colors: np.ndarray | tuple[int, int, int]) -> None:
        # Added anew each time, as their number changes.
        self._scene.add_point_cloud(
            name, points, colors, point_size=self._size, point_shape='circle',
            precision='float32', visible=len(points) > 0)
