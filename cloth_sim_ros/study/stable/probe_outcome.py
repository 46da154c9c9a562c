# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a run that asks for stability came to, and when a growth counts as unstable."""

from dataclasses import dataclass
import math

STABLE = 'stable'
UNSTABLE = 'unstable'
REFUSED = 'refused'

# Of the amplitude at the start. A wave that is stable at 0.999 of its limit reaches 22 times what
# it begins with; at 1.001 of it, a wave grows by 1.09 in each step.
GROWN = 30.0


@dataclass(frozen=True)
class ProbeOutcome:
    """
    The end of one run.

    :param outcome: stable, unstable or refused
    :param growth: largest amplitude over that at the start; infinite for what is not finite
    :param substeps: of the last dt; 0 where the scene was refused
    :param detail: why it was refused, or why the run stopped
    """

    outcome: str
    growth: float = 0.0
    substeps: int = 0
    detail: str = ''

    def as_dict(self) -> dict[str, object]:
        """Return plain values for JSON, which has no infinity: None in its place."""
        return {**vars(self), 'growth': self.growth if math.isfinite(self.growth) else None}


def grown(growth: float, substeps: int, detail: str = '') -> ProbeOutcome:
    """Return the outcome of a run whose amplitude has become ``growth`` times that at first."""
    # Written so that what is no number is unstable.
    return ProbeOutcome(STABLE if growth < GROWN else UNSTABLE, growth, substeps, detail)
