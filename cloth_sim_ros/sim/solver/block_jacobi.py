# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Block-Jacobi: each node on its own."""

from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.solver_pass import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms


class BlockJacobi:
    """The inverse of each node's diagonal block. Needs no pass of its own."""

    is_multigrid = False

    def __init__(self, programs: SolverPrograms, levels: Levels) -> None:
        """Leave it all to the update."""
        self.assembly: list[SolverPass] = []
        self.cycle: list[SolverPass] = []

    def set_law(self, law: EdgeLaw) -> None:
        """Take up nothing."""
