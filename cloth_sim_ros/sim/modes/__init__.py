# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The simulation modes: small objects with the passes of one substep."""

from cloth_sim_ros.sim.modes.adaptive import Adaptive
from cloth_sim_ros.sim.modes.constraint import Constraint
from cloth_sim_ros.sim.modes.layered_adaptive import LayeredAdaptive
from cloth_sim_ros.sim.modes.layered_constraint import LayeredConstraint
from cloth_sim_ros.sim.modes.layered_springs import LayeredSprings
from cloth_sim_ros.sim.modes.mass_spring import MassSpring
from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.modes.paper import paper_mode
from cloth_sim_ros.sim.scene import Scene

__all__ = ('AVAILABLE', 'Mode', 'mode_for')

AVAILABLE: dict[str, type[Mode]] = {
    mode.name: mode for mode in (MassSpring, Constraint, Adaptive)}
# Those for a cloth whose layers touch each other.
_LAYERED: dict[str, type[Mode]] = {
    mode.name: mode for mode in (LayeredSprings, LayeredConstraint, LayeredAdaptive)}


def mode_for(name: str, scene: Scene) -> type[Mode]:
    """Return the class of the mode ``name``, in the form that ``scene`` asks for."""
    if scene['self_contact.enabled']:
        return _LAYERED[name]
    return paper_mode(name, scene) or AVAILABLE[name]
