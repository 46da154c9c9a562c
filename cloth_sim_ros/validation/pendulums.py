# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A rod that swings, and a chain that falls from level, against rigid links."""

from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.reference.rigid_links import fall_from_level
from cloth_sim_ros.reference.rigid_links import period_error
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import PLAIN
import numpy as np

ROD: dict[str, Any] = {
    **PLAIN, 'mode': 'constraint', 'rows': 2, 'cols': 1, 'height': 1.0, 'node_mass': 0.1,
    'pins': ['top_left'], 'start.pose': 'hanging', 'start.z': 0.0, 'auto_substeps': False,
    'solver.tolerance': 1e-6}
# A rod so hard that its weight lengthens it by no more than 1e-6: the rule of constraint.strain
# makes a cloth of one line 1 / 0.03 times as hard, and the rod carries half of the two nodes.
RIGID = {'constraint.strain': 5e-5}


def swing(
        context: Context, angle: float, seconds: float,
        **values: Any) -> tuple[np.ndarray, np.ndarray]:
    """Return the offset of the lower end of a rod from its pin at each step, and its velocity."""
    with Simulation(Scene({**ROD, **RIGID, **values}), context=context) as simulation:
        positions = simulation.snapshot().positions.copy()
        positions[1, 0] = positions[0, 0] + [np.sin(angle), 0.0, -np.cos(angle)]
        simulation.set_state(positions, np.zeros_like(positions))
        offsets, velocities = [], []
        for _ in range(round(seconds / simulation.dt)):
            simulation.step()
            snapshot = simulation.snapshot()
            offsets.append(snapshot.positions[1, 0] - snapshot.positions[0, 0])
            velocities.append(snapshot.velocities[1, 0])
    return np.array(offsets, dtype=float), np.array(velocities, dtype=float)


def period(context: Context, mode: str, nodes: int, dt: float) -> Figure:
    """Return that of a rod from 1 rad, over 4 sqrt(L / g) K(sin(1 / 2))."""
    offsets, _ = swing(context, 1.0, 10.0, mode=mode, rows=nodes, dt=dt)
    return exactly(1.0 + period_error(offsets, dt), 1.0)


def distance_from_links(context: Context, links: int, dt: float) -> float:
    """Return the largest distance of a chain of 1 m from rigid links, up to 0.6 s [m]."""
    times = np.array([0.0, 0.2, 0.4, 0.6])
    exact = fall_from_level(links, 1.0 / links, times)
    worst = 0.0
    with Simulation(Scene({
            **PLAIN, 'mode': 'constraint', 'rows': 1, 'cols': links + 1, 'width': 1.0,
            'node_mass': 0.1, 'pins': ['top_left'], 'dt': dt, 'auto_substeps': False,
            'constraint.strain': 1e-4, 'solver.tolerance': 1e-6}),
            context=context) as simulation:
        for before, now, places in zip(times, times[1:], exact[1:]):
            simulation.step(round((now - before) / dt))
            positions = simulation.positions()[0].astype(float)
            offsets = positions[1:] - positions[0]
            worst = max(worst, float(np.abs(offsets[:, [0, 2]] - places).max()))
    return worst


def order_of_chain(context: Context, mode: str, nodes: int) -> Figure:
    """Return the order in dt of a chain's distance from rigid links, at 5 and 2.5 ms."""
    errors = [distance_from_links(context, nodes - 1, dt) for dt in (0.005, 0.0025)]
    return exactly(np.log2(errors[0] / errors[1]), 1.0)
