# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A small study of the trade, for tests."""

from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import grid_of
from cloth_sim_ros.study.trade.measured import measure
from cloth_sim_ros.study.trade.measured import Measured
from cloth_sim_ros.study.workers import Workers

SOFT = {
    'rows': 8, 'cols': 8, 'stiffness.structural': 20.0, 'stiffness.shear': 20.0,
    'stiffness.bend': 2.0}
GRID = {
    'times': [0.1, 0.2], 'frame': 0.02, 'variants': [],
    'reference': {'refine': [4, 8, 16], 'converged': 1e-3, 'loosely_converged': 1e-3,
                  'float64_node_steps': 1e7},
    'cost': {'rounds': 1, 'margin': 2.0},
    'methods': {'mass_spring': {
        'model': 'springs', 'set': {'mode': 'mass_spring', 'dt': 0.02},
        'over': {'refine': [1, 2, 4]}}}}


def small_grid(**changes: Any) -> Grid:
    """Return the grid with some parts changed."""
    return grid_of({**GRID, **changes})


def small_study(folder: Path, **changes: Any) -> Measured:
    """Make the study of the soft cloth."""
    with ResultsFolder(folder) as results:
        return measure(Scene(SOFT), small_grid(**changes), results, Workers(1))
