# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The settings that were measured, row by row, and which of them no other one beats."""

from collections.abc import Iterable
from dataclasses import dataclass

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.trade.accuracy import Errors
from cloth_sim_ros.study.trade.grid import Setting
from cloth_sim_ros.study.trade.grid import Variant

# Max. error over the side of the cloth [1]; above it the motion is another one.
WORST_ERROR = 0.1


@dataclass(frozen=True)
class Row:
    """
    What was measured of a setting.

    :param run: the result errors were measured on
    :param own: against the reference of its own model; None where there is none
    :param scene: against the reference of the scene as it was given
    :param rounds: wall time in a simulated second of each round, or what it would be with nothing
        beside; empty where it was not timed
    :param wall_share: wall time over processor time, of rows of the variant that were timed
    """

    variant: Variant
    setting: Setting
    run: Result
    own: Errors | None
    scene: Errors | None
    rounds: tuple[float, ...] = ()
    wall_share: float = 1.0

    @property
    def wall_seconds(self) -> float | None:
        """Return the median wall time in a simulated second; None where it was not timed."""
        return sorted(self.rounds)[len(self.rounds) // 2] if self.rounds else None

    @property
    def cost(self) -> float:
        """Return the wall time, or what the processor time lets expect of it."""
        return self.wall_seconds or self.wall_share * self.run.values['processor_seconds']

    def cost_over(self, other: 'Row') -> tuple[float, float, float] | None:
        """Return median, least and most of the cost over that of ``other`` in the same round."""
        if not self.rounds or not other.rounds:
            return None
        ratios = sorted(own / its for own, its in zip(self.rounds, other.rounds))
        return ratios[len(ratios) // 2], ratios[0], ratios[-1]

    @property
    def peak_strain(self) -> float:
        """Return the largest strain of a structural or shear edge at any frame of the run."""
        return float(self.run.arrays['strains'].max())

    @property
    def shows_its_model(self) -> bool:
        """Return whether the run was made and is near to the finest of its model, or is it."""
        return self.run.is_done and (self.own is None or self.own.position <= WORST_ERROR)

    def error(self, of_scene: bool) -> float | None:
        """Return the error in position; None where there is none."""
        errors = self.scene if of_scene else self.own
        return errors.position if errors else None

    def known_error(self, of_scene: bool) -> float:
        """Return the error in position of a row that has one."""
        error = self.error(of_scene)
        assert error is not None
        return error

    @property
    def own_errors(self) -> Errors:
        """Return ``own`` of a row that has it."""
        assert self.own is not None
        return self.own

    @property
    def scene_errors(self) -> Errors:
        """Return ``scene`` of a row that has it."""
        assert self.scene is not None
        return self.scene

    def is_useful(self, of_scene: bool) -> bool:
        """
        Return whether it shows the same motion, and may be compared with the other rows.

        Errors against a scene's own model are compared where the model is that of springs.
        """
        error = self.error(of_scene)
        return error is not None and error <= WORST_ERROR and (
            of_scene or self.setting.model == 'springs')

    def is_choice(self, of_scene: bool) -> bool:
        """Return whether it is useful, and was timed."""
        return self.is_useful(of_scene) and bool(self.rounds)

    def as_dict(self) -> dict[str, object]:
        """Return a flat line of the table."""
        values = self.run.values
        line: dict[str, object] = {
            'resolution': self.variant.resolution, 'stiffness': self.variant.stiffness,
            'method': self.setting.method, 'model': self.setting.model,
            'setting': self.setting.label, 'outcome': self.run.outcome}
        for prefix, errors in (('', self.own), ('scene_', self.scene)):
            for name in ('position', 'strain', 'energy'):
                line[f'{prefix}{name}_error'] = getattr(errors, name) if errors else None
        line['peak_strain'] = self.own.peak_strain if self.own else None
        line.update({name: values.get(name) for name in (
            'substeps', 'passes', 'processor_seconds')})
        wall = self.wall_seconds
        line.update({
            'wall_seconds': wall, 'real_time_factor': 1.0 / wall if wall else None,
            'reason': self.run.reason, 'device': self.run.device, 'run': self.run.key})
        return line


# Which settings no other one beats.


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


def cheapest_of_each(rows: Iterable[Row]) -> list[Row]:
    """Return the cheapest row of each method, of those that show their model."""
    cheapest: dict[str, Row] = {}
    for row in rows:
        best = cheapest.get(row.setting.method)
        if row.shows_its_model and (best is None or row.cost < best.cost):
            cheapest[row.setting.method] = row
    return list(cheapest.values())


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
