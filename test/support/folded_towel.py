# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A small towel on a floor, folded in half or folded by two grippers."""

from cloth_sim_ros.validation.layers import CELL
from cloth_sim_ros.validation.layers import THICKNESS
import numpy as np

SIDE = 13
# The row at the fold: rows before it are the upper half.
FOLD = SIDE // 2
TOWEL = {
    'rows': SIDE, 'cols': SIDE, 'width': CELL * (SIDE - 1), 'height': CELL * (SIDE - 1),
    'pins': ['none'], 'start.pose': 'horizontal', 'start.z': 0.5 * THICKNESS,
    'areal_density': 0.2, 'stiffness.structural': 300.0, 'stiffness.shear': 90.0,
    'stiffness.bend': 0.0, 'damping.structural': 0.02, 'dt': 0.002, 'air.density': 1.225,
    'contact.thickness': THICKNESS, 'colliders.names': ['floor'],
    'colliders.floor.shape': 'plane', 'colliders.floor.friction': 0.5,
    'self_contact.enabled': True, 'self_contact.thickness': THICKNESS,
    'self_contact.friction': 0.3}
HALF = 0.5 * CELL * (SIDE - 1)
# Two corners of row 0 are laid on the last row; the middle of the hems is at HEM.
FOLDING = {
    **TOWEL, 'grasps.start': [0.0, 0.0], 'grasps.name': ['left', 'right'],
    'grasps.position': [-HALF, HALF, 0.001, HALF, HALF, 0.001],
    'grasps.radius': [0.5 * CELL, 0.5 * CELL], 'grasps.layers': ['all', 'top'],
    'grasps.release': [1.2, 1.2], 'grasp_moves.start': [0.0, 0.0, 0.5, 0.5],
    'grasp_moves.name': ['left', 'right', 'left', 'right'],
    'grasp_moves.target': [
        -HALF, 0.0, 0.1, HALF, 0.0, 0.1,
        -HALF, -HALF + 0.002, 0.004, HALF, -HALF + 0.002, 0.004],
    'grasp_moves.speed': [0.4, 0.4, 0.3, 0.3]}
FOLDED_AT = 1.3
HEM = (0.0, -HALF, 0.003)


def folded() -> np.ndarray:
    """Return the towel on the floor, the rows before FOLD on those after, (rows, cols, 3) [m]."""
    row, col = np.indices((SIDE, SIDE))
    return np.stack([
        -CELL * np.abs(row - FOLD), CELL * (col - FOLD),
        THICKNESS * (1.0 + 0.5 * np.sign(FOLD - row))], axis=-1)


def folded_twice() -> np.ndarray:
    """Return the towel on the floor in four layers, (rows, cols, 3) [m]."""
    row, col = np.indices((SIDE, SIDE))
    # Below the middle of the stack the layers are those of folded(), above it in reverse.
    layer, half = np.sign(FOLD - row), np.sign(FOLD - col)
    off_middle = THICKNESS * (1.0 - 0.5 * layer)
    return np.stack([
        -CELL * np.abs(row - FOLD),
        np.where(half == 0, off_middle, -CELL * np.abs(col - FOLD)),
        2.0 * THICKNESS + half * off_middle], axis=-1)
