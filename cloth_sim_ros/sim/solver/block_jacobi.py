# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
