# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a solve ended."""

from dataclasses import dataclass
import math


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
