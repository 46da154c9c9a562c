# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0


"""The unit scene of docs/explanation/numerics.md in mid-drape, to measure on its states."""

from collections.abc import Sequence

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

_STIFFNESS = 1000.0
# Less than the solved step has: explicit damping shortens the substeps of the drape.
_DRAPE_DAMPING = 1e-6 * _STIFFNESS
_SOLVE_DAMPING = 5e-4 * _STIFFNESS


def unit_scene(size: int) -> Scene:
    """Return the unit scene of ``size`` x ``size`` nodes with k = 1000 N/m, as it is solved."""
    return _scene(size, _SOLVE_DAMPING)


def draped_states(
        size: int, times: Sequence[float], context: Context
        ) -> list[tuple[np.ndarray, np.ndarray]]:
    """
    Return positions [m] and velocities [m/s] at rising ``times`` [s] after a level start.

    The cloth is stepped by mode mass_spring.
    """
    simulation = Simulation(_scene(size, _DRAPE_DAMPING), context=context)
    states = []
    for begin, end in zip((0.0, *times), times):
        simulation.advance(end - begin)
        snapshot = simulation.snapshot()
        states.append((snapshot.positions, snapshot.velocities))
    simulation.close()
    return states


def _scene(size: int, damping: float) -> Scene:
    return Scene({
        'rows': size, 'cols': size, 'dt': 0.01,
        'stiffness.structural': _STIFFNESS, 'stiffness.shear': _STIFFNESS,
        'stiffness.bend': 0.1 * _STIFFNESS,
        'damping.structural': damping, 'damping.shear': damping, 'damping.bend': 0.1 * damping})
