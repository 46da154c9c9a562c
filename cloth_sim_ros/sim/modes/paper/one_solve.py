# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The paper's implicit step: one linear solve a substep (section 4.2)."""

from cloth_sim_ros.sim.modes.constraint import Constraint
from cloth_sim_ros.sim.modes.implicit import Newton
from cloth_sim_ros.sim.scene import Scene

# It has no geometric stiffness, and does not allow for the turn of edges.
ONE_SOLVE = Newton(solves=1, foresees_turn=False, beta=0.0)


class PaperConstraint(Constraint):
    """Mode constraint with ``constraint.newton_iterations: 1``."""

    @staticmethod
    def newton(scene: Scene) -> Newton:
        """Return the paper's one solve."""
        return ONE_SOLVE
