# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How a cost grows with a size: the exponent of a power law, and how sure it is."""

from collections.abc import Sequence
from dataclasses import dataclass
import math

import numpy as np


@dataclass(frozen=True)
class Growth:
    """
    The exponent p of cost ~ size^p.

    :param exponent: p, the slope of the line of least squares through the logarithms
    :param error: its standard error, from how far the points are off the line; None for two
        sizes, which a line always meets
    """

    exponent: float
    error: float | None = None

    def __str__(self) -> str:
        """Return it in words."""
        return f'{self.exponent:.2f}' + ('' if self.error is None else f' ± {self.error:.2f}')


def fit_growth(sizes: Sequence[float], costs: Sequence[float]) -> Growth | None:
    """
    Return the exponent of ``costs`` over ``sizes``, all above 0; None below two different sizes.

    The error is sqrt(sum r^2 / (n - 2) / sum (log s - mean)^2) with the residuals r of the
    logarithms. It says how well one power law fits, not how well each cost is known.
    """
    if len(set(sizes)) < 2:
        return None
    x, y = np.log(np.array(sizes, float)), np.log(np.array(costs, float))
    x -= x.mean()
    spread = float(x @ x)
    exponent = float(x @ y) / spread
    if len(x) < 3:
        return Growth(exponent)
    off = y - y.mean() - exponent * x
    return Growth(exponent, math.sqrt(float(off @ off) / (len(x) - 2) / spread))
