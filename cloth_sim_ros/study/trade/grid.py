# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a study of the trade measures: settings and variants, from a YAML file, and its runs."""

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import replace
from itertools import product
import math
from pathlib import Path
from typing import Any

from cloth_sim_ros.files.checked_yaml import load_yaml
from cloth_sim_ros.files.errors import cut
from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.gl.shared_directory import shared_directory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.named_fields import all_fields
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.model.stability import choose_substeps
from cloth_sim_ros.sim.scene import refuse_unknown
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.scene_values import scaled_stiffness


@dataclass(frozen=True)
class Variant:
    """
    A scene that was changed.

    :param resolution: spacings of nodes along each side, over those of the scene
    :param stiffness: of all springs, over that of the scene; their damping stays
    """

    resolution: float = 1.0
    stiffness: float = 1.0

    @property
    def is_scene(self) -> bool:
        """Return whether nothing was changed."""
        return self == Variant()

    @property
    def name(self) -> str:
        """Return what was changed, in a few words."""
        parts = [f'{name} x {factor:g}' for name, factor in vars(self).items() if factor != 1.0]
        return ', '.join(parts) or 'the scene'

    def values(self, scene: Scene) -> dict[str, Any]:
        """Return the parameters of ``scene`` with the changes, without those at their default."""
        rows, cols = (
            n if n == 1 else max(2, round((n - 1) * self.resolution) + 1)
            for n in (scene.rows, scene.cols))
        changed = {
            **scene.values, 'preset': 'none', 'rows': rows, 'cols': cols,
            'node_mass': scene['node_mass'] * scene.node_count / (rows * cols),
            **scaled_stiffness(scene, self.stiffness)}
        for name in ('pins', 'pin_moves.node'):
            # Two pins may come to be one.
            moved = [_moved(node, scene, rows, cols) for node in scene[name]]
            changed[name] = list(dict.fromkeys(moved)) if name == 'pins' else moved
        return without_defaults(changed)


def without_defaults(values: Mapping[str, Any]) -> dict[str, Any]:
    """Return those of ``values`` that differ from their default, with lists for tuples."""
    given = {
        field.name: values[field.name] for field in all_fields(values)
        if field.name in values and field.check(values[field.name]) != field.default}
    return {name: list(value) if isinstance(value, tuple) else value
            for name, value in given.items()}


def _moved(node: str, scene: Scene, rows: int, cols: int) -> str:
    row, comma, col = node.partition(',')
    if not comma:
        return node
    return ','.join(
        str(round(int(place) * (new - 1) / max(old - 1, 1)))
        for place, old, new in ((row, scene.rows, rows), (col, scene.cols, cols)))


# The runs of a trade-off study, read from a YAML file.

_SHORT = {
    'refine': 'refine {}', 'dt': 'dt {:g} s', 'solver.tolerance': 'tolerance {:g}',
    'constraint.newton_iterations': 'solves {}'}
MODELS = ('springs', 'hard', 'limited')
_MOST_SETTINGS = 100_000
_PARTS = ('times', 'frame', 'variants', 'reference', 'cost', 'methods')


@dataclass(frozen=True)
class Setting:
    """
    Scene parameters of a way to step, and the method that they belong to.

    :param method: its name in the grid
    :param model: what finer and finer settings of the method converge to: springs, hard edges or
        springs with a limit
    :param fixed: parameters that all settings of the method have
    :param chosen: parameters that differ between the settings of the method
    """

    method: str
    model: str
    fixed: Mapping[str, Any]
    chosen: Mapping[str, Any]

    @property
    def values(self) -> dict[str, Any]:
        """Return all parameters it sets."""
        return {**self.fixed, **self.chosen}

    @property
    def label(self) -> str:
        """Return what tells it from the others, in a few words."""
        return ', '.join(
            _SHORT[name].format(value) if name in _SHORT else f'{name} {value}'
            for name, value in self.chosen.items())


@dataclass(frozen=True)
class Grid:
    """
    The runs of a trade-off study; the grid file of the project documents each part.

    :param converged: what the reference may change by, over the side, where a time counts
    :param loosely_converged: the same for variants of the scene, and for a scene whose reference
        changes by more than ``converged`` at the first time
    :param settings: of each method in turn; the last one of a method is its finest, and the first
        one of all is what the cost of others is compared with
    """

    times: tuple[float, ...]
    frame: float
    variants: tuple[Variant, ...]
    reference_refine: tuple[int, ...]
    converged: float
    loosely_converged: float
    float64_node_steps: float
    rounds: int
    margin: float
    settings: tuple[Setting, ...]


def quick_grid(grid: Grid) -> Grid:
    """
    Return a part of ``grid`` that takes a fraction of its time.

    It has the scene alone, the coarsest and the finest setting of each method, the first two
    times, and one round of timing.
    """
    by_method: dict[str, list[Setting]] = {}
    for setting in grid.settings:
        by_method.setdefault(setting.method, []).append(setting)
    ends = [
        setting for settings in by_method.values()
        for setting in (settings[0], *settings[-1:] * (len(settings) > 1))]
    return replace(
        grid, times=grid.times[:2], variants=grid.variants[:1], rounds=1, settings=tuple(ends))


def default_grid_path() -> Path:
    """Return the grid that is used when none is given."""
    return shared_directory('config') / 'studies' / 'tradeoff.yaml'


def load_grid(path: str | Path) -> Grid:
    """
    Return the grid in the file at ``path``.

    :raises ClothSimError: when it can't be read, or is no grid
    """
    return grid_of(load_yaml(path), str(path))


def grid_of(given: Any, name: str = 'the grid') -> Grid:
    """Return the grid that ``given`` describes; ClothSimError when it describes none."""
    if not isinstance(given, Mapping) or set(given) != set(_PARTS):
        found = sorted(map(cut, given))[:len(_PARTS) + 1] if isinstance(
            given, Mapping) else type(given).__name__
        raise ClothSimError(
            f'{name} needs {", ".join(_PARTS)}, got {found}: start from {default_grid_path()}')
    try:
        reference, cost = given['reference'], given['cost']
        grid = Grid(
            times=tuple(sorted(map(float, given['times']))), frame=float(given['frame']),
            variants=(Variant(), *(Variant(**variant) for variant in given['variants'])),
            reference_refine=tuple(map(int, reference['refine'])),
            converged=float(reference['converged']),
            loosely_converged=float(reference['loosely_converged']),
            float64_node_steps=float(reference['float64_node_steps']),
            rounds=int(cost['rounds']), margin=float(cost['margin']),
            settings=tuple(
                setting for method, parts in given['methods'].items()
                for setting in _settings(method, parts)))
    except (TypeError, KeyError, ValueError, AttributeError, OverflowError) as error:
        if isinstance(error, ClothSimError):
            raise
        raise ClothSimError(
            f'{name} is not written as {default_grid_path()} is: {type(error).__name__} {error}'
        ) from error
    if len(grid.reference_refine) < 3:
        raise ClothSimError(
            f'reference.refine of {name} has {len(grid.reference_refine)} entries, and 3 are '
            'needed to measure how far the reference has converged: give [1, 2, 4] or more')
    return grid


def _settings(method: str, parts: Mapping[str, Any]) -> list[Setting]:
    model, fixed, over = (parts[name] for name in ('model', 'set', 'over'))
    if model not in MODELS:
        raise ClothSimError(
            f'the model of {method} must be one of {", ".join(MODELS)}, got {shown(model)}')
    refuse_unknown({**fixed, **over}, SCENE_FIELDS)
    count = math.prod(len(choices) for choices in over.values())
    if count > _MOST_SETTINGS:
        raise ClothSimError(
            f'{method} has {count} settings, and at most {_MOST_SETTINGS} are measured: give '
            'fewer values')
    return [
        Setting(method, model, dict(fixed), dict(zip(over, chosen)))
        for chosen in product(*over.values())]


# Which runs a study of the trade is made of.

_TRAJECTORY = 'cloth_sim_ros.study.trade.runs:trajectory'
_REFERENCE = 'cloth_sim_ros.study.trade.runs:spring_reference'
_COST = 'cloth_sim_ros.study.trade.runs:cost'


@dataclass(frozen=True)
class Plan:
    """The runs of ``grid`` on ``scene``."""

    scene: Scene
    grid: Grid

    def trajectory(self, variant: Variant, setting: Setting) -> Run:
        """Return the run that the error of ``setting`` is measured on."""
        return Run(
            _TRAJECTORY, {**variant.values(self.scene), **setting.values}, self._times)

    def references(self, variant: Variant) -> list[Run]:
        """Return the runs of the springs of ``variant``, coarse to fine, to extrapolate from."""
        values = {
            **variant.values(self.scene), 'mode': 'mass_spring', 'auto_substeps': True,
            'dt': self.grid.frame}
        scene = Scene(values)
        frames = self.grid.times[-1] / self.grid.frame
        work = sum(self.grid.reference_refine) * frames * choose_substeps(
            Scene({**values, 'refine': 1})) * scene.node_count
        fits = work <= self.grid.float64_node_steps and not scene['pin_moves.start']
        return [
            Run(_REFERENCE if fits else _TRAJECTORY, {**values, 'refine': refine}, self._times)
            for refine in self.grid.reference_refine]

    def cost(self, variant: Variant, settings: list[Setting]) -> Run:
        """Return the run that measures the wall time of ``settings``, in turn."""
        return Run(_COST, variant.values(self.scene), {
            'settings': [setting.values for setting in settings],
            'seconds': self.grid.times[-1], 'frame': self.grid.frame,
            'rounds': self.grid.rounds})

    @property
    def _times(self) -> dict[str, object]:
        return {'times': list(self.grid.times), 'frame': self.grid.frame}
