# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Strips of a measured fabric against the heavy elastica, the beam and the rod, on any grid.

A scene says what a user measures: size, mass per area, stiffness, rigidity. A strip that bends is
clamped by its first two lines of nodes, so half way between them, and ends at its last nodes.
"""

from functools import lru_cache
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.rest import come_to_rest
from cloth_sim_ros.validation.row import exactly
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import AS_SPRINGS
import numpy as np
from scipy.integrate import solve_bvp

LENGTH = 0.1    # [m] free
DENSITY = 0.1   # [kg/m2]
WEIGHT = DENSITY * 9.81
# Damping time of bending in explicit modes [s]: above it, substeps become shorter.
_DAMPING = 1e-5
# beta L of the first mode of a beam that is clamped at one end [1], and the share of its sines.
_MODE, _SHARE = 1.8751041, 0.7340955
# The strip that is stretched: length [m], N/m, kg/m2.
_HANGING, _STIFFNESS, _HANGING_DENSITY = 0.5, 50.0, 0.2


@lru_cache
def elastica(load: float) -> Any:
    """
    Return an inextensible heavy strip from its clamp on: angle and curvature over s, s over L.

    B theta'' = w (L - s) cos theta, level at the clamp, without curvature at the tip. A heavy
    one is found from one of half the load, as there are other solutions.

    :param load: w L^3 / B, weight per area, length, rigidity
    """
    s, guess = np.linspace(0.0, 1.0, 400), np.zeros((2, 400))
    if load > 1.0:
        lighter = elastica(0.5 * load)
        s, guess = lighter.x, lighter.y
    return solve_bvp(
        lambda s, y: np.vstack((y[1], -load * (1.0 - s) * np.cos(y[0]))),
        lambda begin, end: np.array([begin[0], end[1]]), s, guess, tol=1e-8, max_nodes=100_000)


def tip_of_elastica(load: float) -> tuple[float, float]:
    """Return the tip of that strip: along and down from its clamp, over its length."""
    places = np.linspace(0.0, 1.0, 20_001)
    angles = elastica(load).sol(places)[0]
    along, down = (
        float(np.sum(0.5 * (part[1:] + part[:-1]) * np.diff(places)))
        for part in (np.cos(angles), np.sin(angles)))
    return along, down


def clamped(
        context: Context, mode: str, nodes: int, load: float, lines: int = 2, axis: int = 1,
        **values: Any) -> Simulation:
    """
    Return a simulation of a strip of fabric that is clamped at one end.

    :param nodes: along the strip
    :param load: w L^3 / B
    :param lines: across the strip
    :param axis: 1 for a strip along rows, 0 for one along columns
    """
    cell = LENGTH / (nodes - 1.5)
    rigidity = WEIGHT * LENGTH**3 / load
    damping = float(1.0 / frequency_of_beam(rigidity)) if mode == 'constraint' else _DAMPING
    size = {'cols': nodes, 'rows': lines, 'width': cell * (nodes - 1), 'height': 0.02}
    if axis == 0:
        size = {'rows': nodes, 'cols': lines, 'height': cell * (nodes - 1), 'width': 0.02}
    held = [f'{line},{place}' if axis == 1 else f'{place},{line}'
            for line in range(lines) for place in (0, 1)]
    return Simulation(Scene({
        'mode': mode, **size, 'pins': held, 'areal_density': DENSITY,
        'bending.rigidity': rigidity, 'bending.damping': damping, 'start.z': 0.0,
        'air.density': 0.0, 'dt': 0.002, 'solver.tolerance': 1e-4, 'adaptive.threshold': 0.1,
        **values}), context=context)


def frequency_of_beam(rigidity: float) -> float:
    """Return that of the first mode of a clamped strip [rad/s]."""
    return float((_MODE / LENGTH)**2 * np.sqrt(rigidity / DENSITY))


def tip_of(simulation: Simulation, axis: int = 1) -> tuple[float, float]:
    """Return the place of the tip, from where the strip is clamped, along it and down [m]."""
    positions = simulation.positions().astype(float).mean(axis=1 - axis)
    along = 0 if axis == 1 else 1
    clamp = 0.5 * (positions[0] + positions[1])
    return abs(positions[-1, along] - clamp[along]), clamp[2] - positions[-1, 2]


def hung(
        context: Context, mode: str, nodes: int, load: float, lines: int = 2,
        axis: int = 1) -> tuple[Figure, Figure]:
    """
    Return the chord from clamp to tip of a strip at rest.

    :return: its angle below the level [degrees], and the drop of the tip over the length
    """
    with clamped(context, mode, nodes, load, lines, axis) as simulation:
        come_to_rest(simulation)
        along, down = tip_of(simulation, axis)
    exact = tip_of_elastica(load)
    return (
        exactly(np.degrees(np.arctan2(down, along)), np.degrees(np.arctan2(exact[1], exact[0]))),
        exactly(down / LENGTH, exact[1]))


def frequency(context: Context, mode: str, nodes: int, lines: int = 2) -> Figure:
    """Return the frequency of the first mode, from a quarter of a period [Hz]."""
    rigidity = WEIGHT * LENGTH**3 / 0.5
    values: dict[str, Any] = {
        'gravity': [0.0, 0.0, 0.0], 'dt': 5e-4, 'bending.damping': 0.0}
    with clamped(context, mode, nodes, 0.5, lines, **values) as simulation:
        positions = simulation.positions().astype(float)
        at = _MODE / LENGTH * np.maximum(positions[0, :, 0] - positions[0, :2, 0].mean(), 0.0)
        shape = np.cosh(at) - np.cos(at) - _SHARE * (np.sinh(at) - np.sin(at))
        shape[:2] = 0.0
        positions[..., 2] += 0.005 * LENGTH * shape
        simulation.set_state(positions, np.zeros_like(positions))
        drops = [tip_of(simulation)[1]]
        while drops[-1] < 0.0:
            simulation.step()
            drops.append(tip_of(simulation)[1])
        crossed = simulation.time - simulation.dt * drops[-1] / (drops[-1] - drops[-2])
    return exactly(0.25 / crossed, frequency_of_beam(rigidity) / (2.0 * np.pi))


def stretch(
        context: Context, mode: str, nodes: int, lines: int = 2, axis: int = 0) -> Figure:
    """Return by how much a hanging strip is longer than at rest [mm]."""
    size: dict[str, Any] = {'rows': nodes, 'cols': lines, 'height': _HANGING, 'width': 0.04}
    pins = [f'0,{line}' for line in range(lines)]
    gravity = [0.0, 0.0, -9.81]
    if axis == 1:
        size = {'cols': nodes, 'rows': lines, 'width': _HANGING, 'height': 0.04}
        pins = [f'{line},0' for line in range(lines)]
        gravity = [9.81, 0.0, 0.0]
    with Simulation(Scene({
            'mode': mode, **size, 'pins': pins, 'areal_density': _HANGING_DENSITY,
            'gravity': gravity, 'material.warp': _STIFFNESS, 'material.weft': _STIFFNESS,
            'material.shear': 0.0, 'damping.structural': 0.02, 'air.density': 0.0,
            'bending.rigidity': 0.0, 'start.pose': 'hanging', 'start.z': 0.0, 'dt': 0.005,
            **AS_SPRINGS[mode]}), context=context) as simulation:
        come_to_rest(simulation)
        positions = simulation.positions().astype(float)
    ends = positions[[0, -1]] if axis == 0 else positions[:, [0, -1]].swapaxes(0, 1)
    longer = float(np.linalg.norm(np.subtract(*ends.mean(axis=1)))) - _HANGING
    exact = _HANGING_DENSITY * 9.81 * _HANGING**2 / (2.0 * _STIFFNESS)
    return exactly(1e3 * longer, 1e3 * exact)
