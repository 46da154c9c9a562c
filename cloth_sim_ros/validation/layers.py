# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Sheets of one lattice that lie on each other, cut apart between them."""

from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
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


# A stack on a floor, of a light soft fabric.
SOFT: dict[str, Any] = {
    'stiffness.structural': 100.0, 'stiffness.shear': 30.0, 'bending.rigidity': [2e-6, 2e-6]}
FLOOR: dict[str, Any] = {
    'colliders.names': ['floor'], 'colliders.floor.shape': 'plane',
    'colliders.floor.friction': 0.3, 'contact.thickness': THICKNESS}


class RestingStack:
    """
    Four sheets on a floor after half a second.

    :param nodes: along a side of each
    :param values: of the scene, the mode among them
    """

    def __init__(self, context: Context | None, nodes: int, **values: Any) -> None:
        """Let them lie."""
        scene = layered_scene(4, nodes, **{**SOFT, **FLOOR, **values})
        positions = stacked(scene, 4, (0.05, 0.03), first=THICKNESS / 2.0)
        with Simulation(scene, context=context) as cloth:
            cloth.set_state(positions, np.zeros_like(positions))
            cloth.advance(0.5)
            inside = slice(3 * nodes + 2, -2), slice(2, -2)
            # Heights of the inner nodes of the uppermost sheet [m], and their speeds [m/s].
            self.heights = cloth.positions()[inside][..., 2].astype(float)
            self.speeds = np.abs(cloth.velocities()[inside])
            # Force on the floor over the weight.
            self.load = float(-cloth.contact_forces()[0].force[2] / (scene.mass * 9.81))


def height_of_stack(context: Context, mode: str, nodes: int) -> Figure:
    """Return the mean height of the uppermost of four sheets [mm]."""
    stack = RestingStack(context, nodes, mode=mode)
    return exactly(1e3 * float(stack.heights.mean()), 1e3 * 3.5 * THICKNESS)


def load_of_stack(context: Context, mode: str, nodes: int) -> Figure:
    """Return the force of four sheets on the floor over their weight."""
    return exactly(RestingStack(context, nodes, mode=mode).load, 1.0)
