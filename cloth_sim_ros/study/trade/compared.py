# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compare the runs of a study of the trade with their references."""

from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.trade.errors import errors
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import Setting
from cloth_sim_ros.study.trade.path import path_of
from cloth_sim_ros.study.trade.reference import extrapolated
from cloth_sim_ros.study.trade.reference import finest
from cloth_sim_ros.study.trade.reference import Reference
from cloth_sim_ros.study.trade.row import Row
from cloth_sim_ros.study.trade.variant import Variant

Key = tuple[Variant, str]
Ran = tuple[Variant, Setting, Result]


@dataclass(frozen=True)
class Measured:
    """
    All that came out.

    :param references: by variant and model
    :param times: how many of the grid's times count, by variant
    """

    scene: Scene
    grid: Grid
    references: dict[Key, Reference]
    times: dict[Variant, int]
    rows: list[Row]

    def rows_of(self, variant: Variant) -> list[Row]:
        """Return the rows of one variant."""
        return [row for row in self.rows if row.variant == variant]

    @property
    def truth(self) -> Key:
        """Tell which reference is that of the scene as it was given."""
        return Variant(), own_model(self.scene)


def own_model(scene: Scene) -> str:
    """Return what the mode of ``scene`` models."""
    return AVAILABLE[scene['mode']].edge_model(scene)


def compare(
        scene: Scene, grid: Grid, ran: Sequence[Ran],
        rungs: Mapping[Variant, Sequence[Result]]) -> Measured:
    """
    Return the errors of all runs.

    :param ran: variant, setting and result of each
    :param rungs: runs of the springs of each variant, coarse to fine
    :raises ClothSimError: when there is no reference for the scene itself
    """
    side = max(scene['width'], scene['height'])
    references, times = {}, {}
    for variant, results in rungs.items():
        if all(result.is_done for result in results):
            references[variant, 'springs'] = extrapolated(results, grid.reference_refine)
        by_model: dict[str, list[Result]] = {}
        for of, setting, result in ran:
            if of == variant and setting.model != 'springs' and result.is_done:
                by_model.setdefault(setting.model, []).append(result)
        references.update({
            (variant, model): finest(results) for model, results in by_model.items()})
        springs = references.get((variant, 'springs'))
        allowed = side * (grid.converged if variant.is_scene else grid.variants_converged)
        times[variant] = springs.converged_times(allowed) if springs else 0
    truth = references.get((Variant(), own_model(scene)))
    if truth is None or not times[Variant()]:
        failed = next((result for result in rungs[Variant()] if not result.is_done), None)
        raise ClothSimError(
            'there is no reference for the scene: ' + (
                failed.reason if failed else
                f'it has not converged to {grid.converged:g} of the side at '
                f'{grid.times[0]:g} s: give earlier times, or more in reference.refine')
            + ' (--grid)')
    rows = []
    for variant, setting, result in ran:
        reference = references.get((variant, setting.model))
        own = of_scene = None
        if result.is_done:
            path = path_of(result)
            # The finest run of a model is its reference, and has no error to tell.
            if reference is not None and times[variant] and reference.run != result.key:
                own = errors(path, reference.path, scene, *_counting(grid, times[variant]))
            if truth.run != result.key:
                of_scene = errors(
                    path.on_nodes_of(scene.rows, scene.cols), truth.path, scene,
                    *_counting(grid, times[Variant()]))
        rows.append(Row(variant, setting, result, own, of_scene))
    if not any(row.scene for row in rows if row.variant.is_scene):
        reason = next((row.run.reason for row in rows if row.run.reason), 'there are none')
        raise ClothSimError(f'no setting of the grid could be compared on the scene: {reason}')
    return Measured(scene, grid, references, times, rows)


def _counting(grid: Grid, times: int) -> tuple[int, int]:
    return times, round(grid.times[times - 1] / grid.frame)
