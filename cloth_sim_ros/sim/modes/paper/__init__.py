# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The methods of the paper as printed, for comparison with the modes of this project."""

from cloth_sim_ros.sim.modes.mode import Mode
from cloth_sim_ros.sim.modes.paper.one_solve import PaperConstraint
from cloth_sim_ros.sim.modes.paper.strain_limit import PaperAdaptive
from cloth_sim_ros.sim.modes.paper.two_passes import PaperMassSpring
from cloth_sim_ros.sim.scene import Scene


def paper_mode(name: str, scene: Scene) -> type[Mode] | None:
    """Return the paper's form of the mode ``name`` where ``scene`` asks for it, else None."""
    has_one_solve = scene['constraint.newton_iterations'] == 1
    if name == 'mass_spring' and scene['layout'] == 'paper':
        return PaperMassSpring
    if name == 'constraint' and has_one_solve:
        return PaperConstraint
    if name == 'adaptive' and scene['adaptive.scheme'] == 'paper':
        return PaperAdaptive
    return None
