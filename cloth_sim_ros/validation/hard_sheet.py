# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
A sheet of hard edges that falls from level, against DOP853 on the same edges.

Two corners are held. The oracle is scipy's DOP853, an explicit method of order 8 with error
control, on the law of the edges in mode constraint: no step, no solve and no frozen direction.
"""

from functools import lru_cache

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.edge_law import constraint_law
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import PLAIN
import numpy as np
from scipy.integrate import solve_ivp

SECONDS = 0.2
# Steps between which the order is taken [s].
STEPS = (0.005, 0.0025, 0.00125)
_GRAVITY = 9.81


def scene_of(nodes: int, dt: float, strain: float = 0.008) -> Scene:
    """Return a square sheet of 1 m; ``strain`` is that of an edge that carries its weight."""
    return Scene({
        **PLAIN, 'mode': 'constraint', 'rows': nodes, 'cols': nodes, 'areal_density': 0.2,
        'pins': ['top_left', 'top_right'], 'start.z': 0.0, 'dt': dt, 'auto_substeps': False,
        'solver.tolerance': 1e-6, 'constraint.strain': strain})


@lru_cache(maxsize=4)
def exact_fall(nodes: int, strain: float = 0.008, seconds: float = SECONDS) -> np.ndarray:
    """Return where the nodes are after ``seconds``, (nodes, nodes, 3) [m]."""
    scene = scene_of(nodes, SECONDS, strain)
    law = constraint_law(scene)
    start = scene.start_positions().astype(float).reshape(-1, 3)
    held = np.array([0, nodes - 1])

    def rates(_: float, state: np.ndarray) -> np.ndarray:
        places, speeds = state.reshape(2, -1, 3)
        lengths = law.edges.lengths(places)
        pulls = (law.pull(lengths) / law.compliance)[:, None] * law.edges.directions(places)
        forces = law.edges.scatter(pulls, len(start))
        gains = -forces / scene.node_mass
        gains[:, 2] -= _GRAVITY
        gains[held] = 0.0
        return np.concatenate([speeds, gains]).ravel()

    found = solve_ivp(
        rates, (0.0, seconds), np.concatenate([start, 0.0 * start]).ravel(), method='DOP853',
        rtol=1e-9, atol=1e-10)
    return found.y[:start.size, -1].reshape(nodes, nodes, 3)


def distances(context: Context, nodes: int, dt: float, strain: float = 0.008) -> np.ndarray:
    """Return how far each node is from the exact fall in the end, (nodes, nodes) [m]."""
    with Simulation(scene_of(nodes, dt, strain), context=context) as simulation:
        simulation.advance(SECONDS)
        places = simulation.positions().astype(float)
    return np.linalg.norm(places - exact_fall(nodes, strain), axis=-1)


def root_mean_square(context: Context, mode: str, nodes: int, dt: float) -> Figure:
    """Return that of the distances [mm]."""
    found = distances(context, nodes, dt)
    return exactly(1e3 * float(np.sqrt(np.mean(found**2))), 0.0)


def orders(context: Context, nodes: int, strain: float = 0.008) -> tuple[float, float]:
    """Return the order in dt of the root mean square of the distances, and of the largest."""
    found = [distances(context, nodes, dt, strain) for dt in (STEPS[0], STEPS[-1])]
    doublings = np.log2(STEPS[0] / STEPS[-1])
    mean, largest = (
        float(np.log2(before / after) / doublings)
        for before, after in (
            [np.sqrt(np.mean(each**2)) for each in found], [each.max() for each in found]))
    return mean, largest


def order_of_mean(context: Context, mode: str, nodes: int) -> Figure:
    """Return the order in dt of the root mean square of the distances."""
    return exactly(orders(context, nodes)[0], 1.0)


def order_of_largest(context: Context, mode: str, nodes: int) -> Figure:
    """Return the order in dt of the largest distance."""
    return exactly(orders(context, nodes)[1], 1.0)


def order_of_softer(context: Context, mode: str, nodes: int) -> Figure:
    """Return the order of the largest distance with edges a tenth as hard."""
    return exactly(orders(context, nodes, 0.08)[1], 1.0)
