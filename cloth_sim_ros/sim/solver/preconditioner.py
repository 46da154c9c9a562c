# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What conjugate gradients want of a preconditioner; block-Jacobi, each node on its own."""

from typing import Protocol

from cloth_sim_ros.sim.solver.edge_law import EdgeLaw
from cloth_sim_ros.sim.solver.levels import Levels
from cloth_sim_ros.sim.solver.solver_pass import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms


class Preconditioner(Protocol):
    """
    Makes PRECONDITIONED from RESIDUAL; begin.comp and update.comp make the first smoothing.

    :param assembly: run once for each system, after the blocks of the cloth are inverted
    :param cycle: run in each iteration
    """

    is_multigrid: bool
    assembly: list[SolverPass]
    cycle: list[SolverPass]

    def __init__(self, programs: SolverPrograms, levels: Levels) -> None:
        """Compile the passes."""

    def set_law(self, law: EdgeLaw) -> None:
        """Take up what depends on the weights of the edges, besides the weights."""


class BlockJacobi:
    """The inverse of each node's diagonal block. Needs no pass of its own."""

    is_multigrid = False

    def __init__(self, programs: SolverPrograms, levels: Levels) -> None:
        """Leave it all to the update."""
        self.assembly: list[SolverPass] = []
        self.cycle: list[SolverPass] = []

    def set_law(self, law: EdgeLaw) -> None:
        """Take up nothing."""
