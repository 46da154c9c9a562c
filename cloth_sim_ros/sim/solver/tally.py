# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a solve ended, and those of a step, gathered on the device."""

from dataclasses import dataclass
import math

from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.sim.device import bindings
from cloth_sim_ros.sim.loads.forcing import Forcing
from cloth_sim_ros.sim.solver.solver_programs import SolverPass
from cloth_sim_ros.sim.solver.solver_programs import SolverPrograms
from cloth_sim_ros.sim.state import State
import numpy as np

# Least change of velocity that a residual is measured by, over that of gravity [1], as nothing
# changes at rest; chosen: a moving cloth has the same bits from 0 to 0.1, one at rest takes 4.0
# iterations a solve at 0, 3.1 at 1e-3 and 2.1 at 0.1 (constants.py --only _LEAST_CHANGE).
_LEAST_CHANGE = 0.001
# Figures of tally.comp [1].
_FIGURES = 5


def least_scale(state: State, forcing: Forcing, kick: float) -> float:
    """Return the square of the least change of velocity to solve for [m2/s2]."""
    change = _LEAST_CHANGE * kick * math.hypot(*forcing.everywhere)
    return np.count_nonzero(~state.pinned) * change**2


@dataclass(frozen=True)
class SolveReport:
    """
    What the device says after a solve.

    :param iterations: made
    :param residual: sqrt((r, B r)) over that at the start, r the residual and B the
        preconditioner: as measured before the last iteration, which is expected to reduce it as
        the one before did; NaN where the system or its right side is not finite
    :param reached: whether the residual asked for was reached; never so when it is not finite
    """

    iterations: int
    residual: float
    reached: bool


def report_of(start: float, after: float, iterations: int, tolerance: float) -> SolveReport:
    """
    Return the report of a solve.

    :param start: the scale: the square of the change of velocity that is solved for
    :param after: (r, B r) at the end; rounding alone makes it negative
    """
    if start > 0.0:
        residual = math.sqrt(abs(after / start))
    else:
        residual = 0.0 if start == after == 0.0 else math.nan
    return SolveReport(iterations, residual, math.isfinite(residual) and residual <= tolerance)


@dataclass(frozen=True)
class TallyReport:
    """
    How the solves since the last clearing ended.

    :param most_iterations: of a solve
    :param worst_residual: as in SolveReport, of the worst solve that none went on from
    :param unreached: those that stopped before the residual asked for
    :param solves: how many there were
    :param iterations: of all of them together
    """

    most_iterations: int
    worst_residual: float
    unreached: int
    solves: int
    iterations: int


class Tally:
    """Runs tally.comp after each solve, so that none has to be waited for."""

    def __init__(self, programs: SolverPrograms) -> None:
        """Compile the pass and allocate the figures."""
        self._pass = SolverPass(programs.make('tally.comp'), (1, 1))
        self._buffer = Buffer(np.zeros(_FIGURES, dtype=np.float32), is_polled=True)

    def add(self, tolerance: float, *, is_final: bool) -> None:
        """
        Count the solve whose scalars are bound, beside the passes that follow.

        :param tolerance: that it was to stop at
        :param is_final: False where another one starts from its solution
        """
        self._buffer.bind_storage(bindings.SOLVER_TALLY)
        self._pass.set_float('tolerance_square', tolerance**2)
        self._pass.set_int('is_final', int(is_final))
        self._pass.run_beside()

    def clear(self) -> None:
        """Forget all solves."""
        self._buffer.write(np.zeros(_FIGURES, dtype=np.float32))

    def report(self) -> TallyReport:
        """Return how the solves ended."""
        figures = np.empty(_FIGURES, dtype=np.float32)
        self._buffer.read_into(figures)
        most, worst_square, unreached, solves, iterations = (
            float(figure) for figure in figures)
        return TallyReport(
            int(most), worst_square**0.5, int(unreached), int(solves), int(iterations))

    def delete(self) -> None:
        """Release the figures."""
        self._buffer.delete()
