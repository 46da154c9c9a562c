# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a setting is chosen by, and the chosen one as a parameter file."""

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from typing import Protocol

from cloth_sim_ros.files.checked_yaml import MOST_BYTES
from cloth_sim_ros.files.regular_file import read_regular
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.trade.front import cheapest_within_strain
from cloth_sim_ros.study.trade.front import fastest_within
from cloth_sim_ros.study.trade.front import most_accurate_at
from cloth_sim_ros.study.trade.front import Row
import yaml


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
        """Return whether the measured run is within the bound."""

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
        """Return whether the error is within the bound."""
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
        """Return whether the setting is fast enough."""
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
        """Return whether the largest strain is within the bound."""
        return row.peak_strain <= self.limit

    def in_words(self) -> str:
        """Return what was chosen by."""
        return f'the cheapest setting with a largest strain of {self.limit:g} or less'


BUDGETS = (ErrorBudget, SpeedBudget, StrainBudget)


# A chosen setting as a parameter file that node and `cloth_sim run` take.

_OWN_ERROR, _OWN_SPEED, _OWN_STRAIN = 'error', 'real-time factor', 'largest strain'


def write_choice(
        path: Path, row: Row, budget: Budget, scene_name: str, scene: Scene, *,
        only_changes: bool = True) -> None:
    """
    Write the parameters of ``row``, and where they come from.

    :param only_changes: leave out those that ``scene`` has already
    :raises ClothSimError: when the file can't be written
    """
    values = row.setting.values
    if only_changes:
        changed = Scene({**scene.values, **values})
        values = {name: value for name, value in values.items() if changed[name] != scene[name]}
    head = [
        f'For {scene_name}: {budget.in_words()}.',
        'Written by `cloth_sim study`; give it after the file of the scene.',
        f'device: {row.run.device}',
        f'version: {row.run.version}',
        f'scene sha256: {Run("", dict(scene.values)).scene_sha256}',
        f'nodes: {scene.rows} x {scene.cols}',
        f'{budget.option}: {budget.limit:g}',
        *([f'{_OWN_ERROR}: {row.scene.position:.2e} of the side'] if row.scene else []),
        f'{_OWN_SPEED}: {1.0 / row.cost:.2f}',
        f'{_OWN_STRAIN}: {row.peak_strain:.3f}']
    body = yaml.safe_dump({'/**': {'ros__parameters': values}}, sort_keys=False)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(''.join(f'# {line}\n' for line in head) + body, encoding='utf-8')
    except OSError as error:
        raise ClothSimError(f'{path} cannot be written: {error}') from error


def read_choice(path: Path) -> tuple[dict[str, Any], Budget, str]:
    """Return parameters and budget of a file that ``write_choice`` made, and what it tells."""
    values = load_parameters(path)
    told = dict(
        line.removeprefix('# ').split(': ', 1)
        for line in read_regular(path, MOST_BYTES).decode().splitlines()
        if line.startswith('# ') and ': ' in line)
    summary = ', '.join(
        f'{name} {told[name]}' for name in (_OWN_ERROR, _OWN_SPEED, _OWN_STRAIN) if name in told)
    for budget in BUDGETS:
        if budget.option in told:
            try:
                return values, budget(float(told[budget.option])), summary
            except ValueError:
                break  # a word where a number should be tells no more than nothing
    raise ClothSimError(
        f'{path} does not state its budget: give a file that '
        f'{" or ".join(f"--{budget.option}" for budget in BUDGETS)} wrote')
