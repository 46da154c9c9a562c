# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth that lies on a slope with friction slides from tan(angle) = mu on, and not before."""

from collections.abc import Callable
import math
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.validation.row import Figure
from cloth_sim_ros.validation.springs import PLAIN
import numpy as np

GRAVITY = 9.81
FLOOR: dict[str, Any] = {'colliders.names': ['floor'], 'colliders.floor.shape': 'plane'}
LYING: dict[str, Any] = {
    'rows': 8, 'cols': 6, 'width': 0.5, 'height': 0.7, 'pins': ['none'], 'dt': 0.002,
    'contact.thickness': 0.0, 'start.z': 0.0}


def inclined(angle: float) -> list[float]:
    """Return gravity on a plane that goes down along x, z being its normal [m/s2]."""
    return [GRAVITY * math.sin(angle), 0.0, -GRAVITY * math.cos(angle)]


class Slope:
    """
    A cloth that lies on a slope with friction, in one mode.

    :param simulate: from the values of a scene to its simulation
    :param friction: mu
    :param others: values of the scene that differ from those of LYING
    """

    def __init__(
            self, simulate: Callable[[dict[str, Any]], Simulation], mode: str, friction: float,
            **others: Any) -> None:
        """Set the tolerance of mu: the rounding of hard edges, or of springs."""
        self._simulate, self._friction = simulate, friction
        self._scene = {**LYING, **FLOOR, 'mode': mode, **others}
        self.allowed = 1e-3 if mode == 'constraint' else 1e-4
        # The way at that share more than what would just hold.
        self.gained = (
            0.5 * GRAVITY * math.cos(math.atan(friction)) * friction * self.allowed * 0.5**2)

    def way(self, share: float) -> np.ndarray:
        """Return how far nodes slide in 0.5 s on a slope of ``share`` of mu [m]."""
        with self._simulate({
                **self._scene, 'colliders.floor.friction': self._friction,
                'gravity': inclined(math.atan(share * self._friction))}) as simulation:
            begin = simulation.positions()
            simulation.advance(0.5)
            return (simulation.positions() - begin)[..., 0]

    def bracket(self) -> tuple[float, float]:
        """Return tan(angle) / mu at which it sticks and at which it slides, a tenth apart."""
        sticking, sliding = 1.0 - 1e-3, 1.0 + self.allowed
        while sliding - sticking > 0.1 * self.allowed:
            middle = 0.5 * (sticking + sliding)
            if self.way(middle).min() > 0.5 * self.gained:
                sliding = middle
            else:
                sticking = middle
        return sticking, sliding


def slip_tangent(context: Context, mode: str, nodes: int, friction: float) -> Figure:
    """Return the middle of the slopes, tan(angle), at which a cloth sticks and slides."""
    def simulate(values: dict[str, Any]) -> Simulation:
        return Simulation(Scene({**PLAIN, **values}), context=context)

    sticking, sliding = Slope(simulate, mode, friction, rows=nodes, cols=3 * nodes // 4).bracket()
    return Figure(0.5 * friction * (sticking + sliding), friction, friction)


def creep(context: Context, mode: str, nodes: int, angle: float, seconds: float) -> Figure:
    """Return the speed of a cloth on a slope of 0.99 of the friction limit [um/s]."""
    with Simulation(Scene({
            **PLAIN, **LYING, **FLOOR, 'rows': nodes, 'cols': 3 * nodes // 4, 'mode': mode,
            'gravity': inclined(angle), 'colliders.floor.friction': math.tan(angle) / 0.99}),
            context=context) as simulation:
        simulation.advance(0.1)
        begin = simulation.positions()
        simulation.advance(seconds)
        way = float(np.abs(simulation.positions() - begin).max())
    return Figure(1e6 * way / seconds, 0.0, 0.0)
