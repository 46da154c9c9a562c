# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Loops of a measured fabric against the elastica: Peirce's heart and pear loops.

Both ends of a strip are clamped back to back, and it hangs from them: upwards out of the clamp for
a heart, downwards for a pear. The oracle is the boundary value problem of the inextensible
elastica, solved here. Contact between the two ends is not modelled.

A clamp holds the first two and the last two columns of nodes. Curvature is the angle between two
neighbouring edges over their spacing, so an edge has the direction of the elastica at its middle,
and the angle at a node is that of the half edges beside it. A strip whose first edge can't turn
bends from the middle of that edge on: the free length is that between the middles of the first and
the last edge.
"""

from functools import lru_cache
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.rest import come_to_rest
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
import numpy as np
from scipy.integrate import solve_bvp

LENGTH = 0.1    # [m] free
WIDTH = 0.05    # [m]; a light heart of 0.01 twists out of its plane within 0.3 s
DENSITY = 0.1   # [kg/m2]
WEIGHT = DENSITY * 9.81
# Rigidity of a strip without weight [N m]: all have the same shape.
WEIGHTLESS = 1e-4
# Stretches by 1e-3 at most in explicit modes; oblong cells allow little shear [N/m].
STIFF = {'material.warp': 2000.0, 'material.weft': 2000.0, 'material.shear': 0.2}
# Direction in which the first end leaves the clamp [rad].
BEGIN = {'heart': 0.5 * np.pi, 'pear': -0.5 * np.pi}
# Damping time of bending in explicit modes [s]: above it, substeps become shorter.
DAMPING = 1e-5
# Kinetic energy of a strip at rest, over the largest on its way there [1]: what rounding keeps up
# in a heart without weight is 1.2e-6.
REST = 2e-6
# Frequency of a beam clamped at both ends [rad/s], over sqrt(B / m) / L^2.
MODE = 22.373


@lru_cache
def elastica(kind: str, load: float) -> Any:
    """
    Return half a loop from its clamp: angle, curvature, x and z over s, lengths over L.

    B theta'' = w (L / 2 - s) cos theta + H sin theta, where the halves push each other with H at
    the lowest point. A heavy one is found from a lighter one, as there are other solutions.
    """
    begin = BEGIN[kind]
    if load == 0:
        s = np.linspace(0.0, 0.5, 101)
        angle = begin - (begin + np.pi) * 2.0 * s
        if kind == 'pear':
            angle += np.sin(2.0 * np.pi * s)
        guess = np.array([angle, np.gradient(angle, s), 0.1 * np.sin(2.0 * np.pi * s), 0.0 * s])
        push = np.zeros(1)
    else:
        lighter = elastica(kind, max(load - 16, 0))
        s, guess, push = lighter.x, lighter.y, lighter.p
    found = solve_bvp(
        lambda s, y, p: np.array([
            y[1], load * (0.5 - s) * np.cos(y[0]) + p[0] * np.sin(y[0]), np.cos(y[0]),
            np.sin(y[0])]),
        lambda top, low, p: np.array([
            top[0] - begin, top[2], top[3], low[0] + np.pi, low[2]]),
        s, guess, p=push, tol=1e-6, max_nodes=100_000)
    if not found.success:
        raise RuntimeError(f'no {kind} of load {load}: {found.message}')
    return found


def height_of_elastica(kind: str, load: float) -> float:
    """Return the distance from the clamp to the lowest point over the length."""
    return -float(elastica(kind, load).y[3, -1])


def nodes_of_elastica(kind: str, load: float, columns: int) -> np.ndarray:
    """Return x and z of each column of nodes [m], (columns, 2), those of the clamps too."""
    spacing = 1.0 / (columns - 2)
    s = (np.arange(columns) - 0.5) * spacing
    _, _, x, z = elastica(kind, load).sol(np.clip(np.minimum(s, 1.0 - s), 0.0, 0.5))
    x = np.where(s <= 0.5, -x, x)
    first = 0.5 * spacing * np.sin(BEGIN[kind])
    for clamped, height in ((0, -first), (1, first)):
        for column in (clamped, columns - 1 - clamped):
            x[column], z[column] = 0.0, height
    return LENGTH * np.stack([x, z], axis=-1)


def strip(
        context: Context, mode: str, columns: int, load: float, **values: Any) -> Simulation:
    """Return a strip held by two columns at each end, weightless for a load of 0."""
    rigidity = WEIGHT * LENGTH**3 / load if load else WEIGHTLESS
    period = LENGTH**2 * np.sqrt(DENSITY / rigidity) / MODE
    held = [
        f'{line},{column}' for line in (0, 1) for column in (0, 1, columns - 2, columns - 1)]
    return Simulation(Scene({
        'mode': mode, 'rows': 2, 'cols': columns, 'height': WIDTH,
        'width': LENGTH * (columns - 1) / (columns - 2), 'pins': held, **STIFF,
        'areal_density': DENSITY, 'bending.rigidity': rigidity,
        'bending.damping': float(0.3 * period) if mode == 'constraint' else DAMPING,
        'gravity': [0.0, 0.0, -9.81 if load else 0.0], 'start.z': 0.0, 'air.density': 0.0,
        'dt': 0.002, 'solver.tolerance': 1e-4, **values}), context=context)


def begin_as(simulation: Simulation, kind: str, load: float) -> None:
    """Start from the elastica of a load."""
    positions = simulation.positions().astype(float)
    positions[..., [0, 2]] = nodes_of_elastica(kind, load, simulation.scene.cols)
    simulation.set_state(positions, np.zeros_like(positions))


def move_clamps(simulation: Simulation, apart: float, angle: float) -> None:
    """Move the clamps to either side of the middle, the left one turned by an angle, in 0.04 s."""
    positions = simulation.positions().astype(float)
    half = 0.5 * LENGTH / (simulation.scene.cols - 2)
    last = simulation.scene.cols - 1
    for row, column in np.argwhere(simulation.pinned_nodes()):
        side, along = (-1.0, column) if column < 2 else (1.0, last - column)
        out = apart + half * np.cos(angle) * (1.0 if along == 0 else -1.0)
        up = half * np.sin(angle) * (-1.0 if along == 0 else 1.0)
        here = positions[row, column]
        target = np.array([side * out, here[1], up])
        speed = max(float(np.linalg.norm(target - here)) / 0.04, 1e-3)
        simulation.move_pin(row, column, target.tolist(), speed=speed)
    simulation.advance(0.044)


def height_of(simulation: Simulation) -> float:
    """Return the distance from the clamp to the node in the middle over the length."""
    down = -simulation.positions()[..., 2].astype(float).mean(axis=0)
    return float(down[len(down) // 2] - 0.5 * (down[0] + down[1])) / LENGTH


def settle(simulation: Simulation) -> None:
    """Wait until a loop is at rest."""
    come_to_rest(simulation, 0.5, REST, 2000)


def height(context: Context, mode: str, columns: int, kind: str, load: float) -> Figure:
    """Return the distance from the clamp to the lowest point of a loop, over its length."""
    with strip(context, mode, columns, load) as simulation:
        begin_as(simulation, kind, 0 if load == 512 else 512)
        settle(simulation)
        return exactly(height_of(simulation), height_of_elastica(kind, load))
