# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a setting is chosen by: an error, a speed or a strain that it has to keep to."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from cloth_sim_ros.study.trade.front import cheapest_within_strain
from cloth_sim_ros.study.trade.front import fastest_within
from cloth_sim_ros.study.trade.front import most_accurate_at
from cloth_sim_ros.study.trade.row import Row


class Budget(Protocol):
    """
    A bound on what is measured of a setting, and which of those within it to take.

    ``option`` is its argument of the study, without the dashes; ``limit`` its value.
    """

    @property
    def option(self) -> str:
        """Get its argument of the study."""

    @property
    def limit(self) -> float:
        """Get the value of that argument."""

    def choose(self, rows: Iterable[Row]) -> Row:
        """Return the setting to take; ClothSimError when none is within the bound."""

    def holds(self, row: Row) -> bool:
        """Tell whether what was measured keeps to the bound."""

    def in_words(self) -> str:
        """Return what was chosen by."""


@dataclass(frozen=True)
class ErrorBudget:
    """
    The fastest setting within an error.

    :param limit: over the side of the cloth
    """

    limit: float
    option = 'budget-error'

    def choose(self, rows: Iterable[Row]) -> Row:
        """Return the fastest setting within the error."""
        return fastest_within(rows, self.limit)

    def holds(self, row: Row) -> bool:
        """Tell whether the error is within the bound."""
        return row.scene_errors.position <= self.limit

    def in_words(self) -> str:
        """Return what was chosen by."""
        return f'the fastest setting with an error of {self.limit:g} of the side or less'


@dataclass(frozen=True)
class SpeedBudget:
    """
    The most exact setting that is fast enough.

    :param limit: the least real-time factor
    """

    limit: float
    option = 'budget-rtf'

    def choose(self, rows: Iterable[Row]) -> Row:
        """Return the most exact setting that is fast enough."""
        return most_accurate_at(rows, self.limit)

    def holds(self, row: Row) -> bool:
        """Tell whether the setting is fast enough."""
        return 1.0 / row.cost >= self.limit

    def in_words(self) -> str:
        """Return what was chosen by."""
        return f'the most accurate setting with a real-time factor of {self.limit:g} or more'


@dataclass(frozen=True)
class StrainBudget:
    """
    The cheapest setting, of any mode, that stretches no further.

    :param limit: the largest strain of a structural or shear edge at any frame
    """

    limit: float
    option = 'budget-strain'

    def choose(self, rows: Iterable[Row]) -> Row:
        """Return the cheapest setting within the strain."""
        return cheapest_within_strain(rows, self.limit)

    def holds(self, row: Row) -> bool:
        """Tell whether the largest strain is within the bound."""
        return row.peak_strain <= self.limit

    def in_words(self) -> str:
        """Return what was chosen by."""
        return f'the cheapest setting with a largest strain of {self.limit:g} or less'


BUDGETS = (ErrorBudget, SpeedBudget, StrainBudget)
