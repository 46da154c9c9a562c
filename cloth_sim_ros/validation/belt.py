# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A belt round a drum slips at the ratio of tensions that Euler and Eytelwein found."""

import math
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import PLAIN
import numpy as np

RADIUS, WRAP, ON_DRUM, FREE_NODES = 0.1, math.pi, 15, 4
TURN = WRAP / ON_DRUM  # at each node on the drum
LENGTH = 2.0 * RADIUS * math.sin(TURN / 2.0)
ROWS, WIDTH = ON_DRUM + 2 * FREE_NODES, 0.02
LOAD = 1.0  # [N] at the slack end
# A share of the default: the harder edges are, the more they amplify what friction is off by.
HARD: dict[str, dict[str, Any]] = {
    'mass_spring': {}, 'adaptive': {}, 'constraint': {'constraint.strain': 1e-4}}
BELT: dict[str, Any] = {
    'rows': ROWS, 'cols': 2, 'width': WIDTH, 'height': LENGTH * (ROWS - 1), 'areal_density': 1.0,
    'gravity': [0.0, 0.0, 0.0], 'dt': 0.001, 'stiffness.structural': 2e4, 'stiffness.shear': 1e3,
    'stiffness.bend': 0.0, 'damping.structural': 1.0, 'contact.thickness': 0.0,
    'pins': ['bottom_edge'], 'colliders.names': ['drum'], 'colliders.drum.shape': 'cylinder',
    'colliders.drum.size': [RADIUS, 0.2],
    'colliders.drum.orientation': [math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5)]}


def laid_on_drum() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return positions on the drum, (rows, 2, 3), and the directions of both free ends."""
    angles = [0.5 * (math.pi + WRAP - TURN) - TURN * number for number in range(ON_DRUM)]

    def at(angle: float) -> np.ndarray:
        return np.array([math.cos(angle), 0.0, math.sin(angle)])

    slack = at(angles[0] + 0.5 * (TURN + math.pi))
    pulled = at(angles[-1] - 0.5 * (TURN + math.pi))
    on = [RADIUS * at(angle) for angle in angles]
    line = np.array([
        *(on[0] + LENGTH * number * slack for number in range(FREE_NODES, 0, -1)), *on,
        *(on[-1] + LENGTH * number * pulled for number in range(1, FREE_NODES + 1))])
    return line[:, None] + np.array([[0.0, -WIDTH / 2, 0.0], [0.0, WIDTH / 2, 0.0]]), slack, pulled


def pull_slowly(
        simulation: Simulation, positions: np.ndarray, slack: np.ndarray, way: np.ndarray) -> None:
    """Lay the belt, load its slack end, and begin to pull the other one along ``way`` [m]."""
    simulation.set_state(
        positions.astype(np.float32), np.zeros(positions.shape, dtype=np.float32))
    simulation.push(
        tuple(LOAD * slack), duration=100.0, region='sphere',
        center=tuple(positions[0].mean(axis=0)), radius=0.03)
    simulation.advance(0.05)
    for col in range(2):
        simulation.move_pin(len(positions) - 1, col, tuple(positions[-1, col] + way), 0.005)


def ratio_of_tensions(context: Context, mode: str, friction: float) -> Figure:
    """Return the tension of a belt that slips, over that at its slack end, of a polygon."""
    with Simulation(Scene({
            **PLAIN, **BELT, 'mode': mode, 'colliders.drum.friction': friction, **HARD[mode]}),
            context=context) as simulation:
        positions, slack, pulled = laid_on_drum()
        pull_slowly(simulation, positions, slack, 0.003 * pulled)
        simulation.advance(0.2)
        tensions = []
        for _ in range(25):
            simulation.step()
            tensions.append(abs(float((simulation.pin_forces().forces @ pulled).sum())))
    # A polygon turns by as much at each node.
    share = friction * math.tan(0.5 * TURN)
    return exactly(float(np.mean(tensions)) / LOAD, ((1.0 + share) / (1.0 - share))**ON_DRUM)
