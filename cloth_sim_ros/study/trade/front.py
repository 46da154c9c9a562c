# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Which settings no other one beats."""

from collections.abc import Iterable

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.trade.row import Row


def front(rows: Iterable[Row], *, of_scene: bool) -> list[Row]:
    """Return the choices that are more exact than all that cost less, cheapest first."""
    kept: list[Row] = []
    choices = [row for row in rows if row.is_choice(of_scene)]
    for row in sorted(choices, key=lambda row: row.cost):
        if not kept or row.known_error(of_scene) < kept[-1].known_error(of_scene):
            kept.append(row)
    return kept


def near_front(rows: Iterable[Row], margin: float, *, of_scene: bool) -> list[Row]:
    """Return the useful rows that none as exact beats by ``margin`` or more in cost."""
    useful = [row for row in rows if row.is_useful(of_scene)]
    return [
        row for row in useful if not any(
            other.known_error(of_scene) <= row.known_error(of_scene)
            and margin * other.cost < row.cost
            for other in useful)]


def fastest_within(rows: Iterable[Row], error: float) -> Row:
    """Return the fastest timed row of which the error is ``error`` or less."""
    timed = _timed(rows)
    fitting = [row for row in timed if row.known_error(True) <= error]
    if not fitting:
        least = min((row.known_error(True) for row in timed), default=float('nan'))
        raise ClothSimError(
            f'no setting has an error of at most {error:g} of the side, the least is {least:.2g}: '
            'give a larger --budget-error, or finer settings in a --grid')
    return min(fitting, key=lambda row: row.cost)


def most_accurate_at(rows: Iterable[Row], real_time_factor: float) -> Row:
    """Return the timed row with the least error of those that are fast enough."""
    timed = _timed(rows)
    fitting = [row for row in timed if 1.0 / row.cost >= real_time_factor]
    if not fitting:
        most = max((1.0 / row.cost for row in timed), default=float('nan'))
        raise ClothSimError(
            f'no setting has a real-time factor of {real_time_factor:g}, the largest is '
            f'{most:.2g}: give a smaller --budget-rtf, or use fewer nodes')
    return min(fitting, key=lambda row: row.known_error(True))


def within_strain(rows: Iterable[Row], strain: float) -> list[Row]:
    """Return the rows whose largest strain is ``strain`` or less, cheapest first."""
    return sorted(
        (row for row in rows if row.shows_its_model and row.peak_strain <= strain),
        key=lambda row: row.cost)


def cheapest_within_strain(rows: Iterable[Row], strain: float) -> Row:
    """Return the cheapest timed row of which the largest strain is ``strain`` or less."""
    rows = list(rows)
    fitting = [row for row in within_strain(rows, strain) if row.rounds]
    if not fitting:
        least = min(
            (row.peak_strain for row in rows if row.shows_its_model), default=float('nan'))
        raise ClothSimError(
            f'no setting has a strain of at most {strain:g}, the least is {least:.2g}: give a '
            'larger --budget-strain, or settings with hard edges or a smaller limit in a --grid')
    return fitting[0]


def _timed(rows: Iterable[Row]) -> list[Row]:
    return [row for row in rows if row.is_choice(True)]
