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
