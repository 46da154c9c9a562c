# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The simulation modes: small objects that know the passes of one substep."""

from cloth_sim_ros.sim.modes.adaptive import Adaptive
from cloth_sim_ros.sim.modes.constraint import Constraint
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.modes.mode import finish
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.modes.mode import Pieces
from cloth_sim_ros.sim.modes.mode import Steps

__all__ = ('AVAILABLE', 'Mode', 'Pieces', 'Steps', 'finish')

AVAILABLE: dict[str, type[Mode]] = {
    mode.name: mode for mode in (MassSpring, Constraint, Adaptive)}
