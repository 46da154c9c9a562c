# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Sheets of one lattice that lie on each other, cut apart between them."""

from typing import Any

from cloth_sim_ros.sim.scene import Scene
import numpy as np

CELL = 0.02
THICKNESS = 0.002


def layered_scene(layers: int, nodes: int = 8, **others: Any) -> Scene:
    """Return a scene of ``layers`` sheets of ``nodes`` a side with cells of 2 cm."""
    rows = layers * nodes
    width, height = CELL * (nodes - 1), CELL * (rows - 1)
    holes: list[float] = []
    for layer in range(1, layers):
        # One row of cells.
        top = 0.5 * height - CELL * (layer * nodes - 1)
        holes += [-width, top, width, top, width, top - CELL, -width, top - CELL]
    return Scene({
        'rows': rows, 'cols': nodes, 'width': width, 'height': height, 'shape.holes': holes,
        'shape.hole_corners': [4] * (layers - 1), 'shape.pieces': layers, 'pins': ['none'],
        'start.z': 0.0, 'areal_density': 0.2, 'dt': 0.002, 'self_contact.enabled': True,
        'self_contact.thickness': THICKNESS, **others})


def stacked(scene: Scene, layers: int, shift: tuple[float, float] = (0.37, 0.21),
            first: float = 0.0, apart: float = THICKNESS) -> np.ndarray:
    """
    Return positions of the sheets one above the other, (rows, cols, 3) [m].

    :param shift: of each against the one below, in cells
    :param first: height of the lowest [m]
    :param apart: height of each above the one below [m]
    """
    nodes = scene.rows // layers
    row, col = np.indices((scene.rows, scene.cols))
    layer = row // nodes
    return np.stack([
        CELL * (col + shift[0] * layer), -CELL * (row % nodes + shift[1] * layer),
        first + apart * layer], axis=-1).astype(float)
