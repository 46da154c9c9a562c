# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The same springs in float64: the run that errors are measured against."""

from collections.abc import Sequence
from typing import Any

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.scene import Scene
import numpy as np


def spring_reference(
        scene: dict[str, Any], *, times: Sequence[float], frame: float) -> dict[str, Any]:
    """
    Return positions at ``times``, strain and energies at every ``frame``, as trajectory does.

    The timed moves of pins are not made here.
    """
    cloth = MassSpringReference(Scene({**scene, 'dt': frame}))
    positions, strains, energies = [], [], []
    for number in range(1, round(times[-1] / frame) + 1):
        cloth.step()
        strains.append(float(cloth.node_strain().max()))
        now = cloth.energies()
        energies.append([now.kinetic, now.elastic, now.gravitational])
        if any(abs(number * frame - moment) < 1e-6 for moment in times):
            positions.append(cloth.positions.copy())
    return {'device': 'NumPy, float64', 'positions': np.array(positions),
            'strains': np.array(strains), 'energies': np.array(energies)}
