# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One row of the validation table: what is measured, what is true, and how far off is allowed."""

from collections.abc import Callable
from dataclasses import dataclass

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.model.scene_fields import MODES


@dataclass(frozen=True)
class Figure:
    """
    What was measured, beside what is true.

    :param value: in the unit of its row
    :param least: smallest value that is true: that of the formula, or of the published range
    :param most: largest one
    """

    value: float
    least: float
    most: float

    @property
    def off(self) -> float:
        """Return the distance from the true range, in the unit of the row."""
        return max(self.least - self.value, self.value - self.most, 0.0)


def exactly(value: float, truth: float) -> Figure:
    """Return a figure that a formula gives."""
    return Figure(float(value), float(truth), float(truth))


# From a context, a mode and the nodes along the longer side.
Measure = Callable[[Context, str, int], Figure]


@dataclass(frozen=True)
class Row:
    """
    A scene with a known outcome.

    :param name: family and scene, as `--only` takes it
    :param what: the scene and its figure, for the table
    :param truth: formula, or measurement with its source
    :param unit: of the figure; empty for a ratio
    :param allowed: largest distance from the truth, over it where that is not 0
    :param measure: the measurement
    :param grids: nodes along the longer side
    :param modes: those that the truth holds in
    :param is_long: whether it takes more than some 20 s of a processor in a mode
    :param shortfall: why a figure is off by more, where that is known
    """

    name: str
    what: str
    truth: str
    unit: str
    allowed: float
    measure: Measure
    grids: tuple[int, ...]
    modes: tuple[str, ...] = MODES
    is_long: bool = False
    shortfall: str = ''

    def off(self, figure: Figure) -> float:
        """Return how far a figure is off, as ``allowed`` has it."""
        nearest = figure.least if figure.value < figure.least else figure.most
        return figure.off / abs(nearest) if nearest else figure.off

    def holds(self, figure: Figure) -> bool:
        """Return whether a figure is within what is allowed; False for one that is not finite."""
        return self.off(figure) <= self.allowed
