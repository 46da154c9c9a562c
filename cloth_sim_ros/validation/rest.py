# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a scene comes to rest, in modes that damp and in modes that hardly do."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np


def come_to_rest(
        simulation: Simulation, seconds: float = 2.0, share: float = 1e-6,
        most_steps: int = 20_000) -> None:
    """
    Wait in mode constraint; else stop all nodes whenever their kinetic energy begins to fall.

    Explicit modes take minutes to come to rest by their damping. Stopping changes no equilibrium.

    :param seconds: to wait [s]
    :param share: kinetic energy at rest over the largest on the way there
    :raises ClothSimError: if it is not at rest after ``most_steps``
    """
    if simulation.mode == 'constraint':
        simulation.advance(seconds)
        return
    largest = before = 0.0
    for _ in range(most_steps):
        simulation.step()
        now = simulation.measure().kinetic_energy
        if now < before:
            if before < share * largest:
                return
            largest = max(largest, before)
            positions = simulation.positions()
            simulation.set_state(positions, np.zeros_like(positions))
            now = 0.0
        before = now
    raise ClothSimError(
        f'not at rest after {most_steps} steps, {before:.3g} of {largest:.3g} J are left: '
        'take a larger share')
