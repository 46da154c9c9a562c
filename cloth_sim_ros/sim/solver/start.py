# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where a solve starts."""

from dataclasses import dataclass

from cloth_sim_ros.gl.program import Program


@dataclass(frozen=True)
class Start:
    """
    Where a solve starts, and where it takes the law of each edge for a straight line.

    :param field: of SolverBuffers, a change of velocity
    :param share: of it
    :param judges_by_tension: at the length that the tension found last belongs to, where a limit
        pulled; else at the length that the start leads to
    """

    field: int
    share: float
    judges_by_tension: bool = False

    def set_in(self, program: Program) -> None:
        """Set it in the program in use."""
        program.set_int('start_field', self.field)
        program.set_float('guess', self.share)
        program.set_int('judges_by_tension', int(self.judges_by_tension))
