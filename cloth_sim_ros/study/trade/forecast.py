# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long a study of the trade will take, from a few steps of each method before it begins."""

from dataclasses import dataclass
import time
from typing import Any

from cloth_sim_ros.reference.explicit_cloth import MassSpringReference
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.stability import choose_substeps
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.stop import StepAbandoned
from cloth_sim_ros.study.make_runs import in_minutes
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.trade.grid import Grid
from cloth_sim_ros.study.trade.grid import Plan
from cloth_sim_ros.study.trade.grid import Variant

# Wall time for the steps of one method, and for all of them [s]; chosen: a forecast within ten
# seconds, of which the last method may compile for some.
_PROBE = 1.0
_PROBES = 4.0


@dataclass(frozen=True)
class EarlyForecast:
    """
    The wall time of a study [s].

    :param runs: to be made
    :param accuracy: of the runs that errors are measured on
    :param timing: of the runs that follow, if all settings are timed
    :param is_least: whether a method was too slow to be measured, so that it takes longer
    """

    runs: int
    accuracy: float
    timing: float
    is_least: bool

    def in_words(self, processes: int, hint: str = '') -> str:
        """Return it as a sentence, with a way to a shorter study."""
        least = 'more than ' if self.is_least else ''
        return (
            f'{self.runs} runs in {processes} processes take {least}{in_minutes(self.accuracy)}, '
            f'and timing the best of them up to {in_minutes(self.timing)}'
            f'{f"; {hint}" if hint else ""}')


def forecast(
        scene: Scene, grid: Grid, results: ResultsFolder, processes: int) -> EarlyForecast:
    """
    Return how long the study takes, measured within a few seconds.

    Runs that ``results`` has are not made again. Work grows with the nodes and ``refine``, in
    mode mass_spring with the substeps.
    """
    plan = Plan(scene, grid)
    costs, is_least = _costs_of_methods(plan)
    seconds = grid.times[-1]
    todo, timing = [], 0.0
    for variant in grid.variants:
        values = variant.values(scene)
        for setting in grid.settings:
            cost = costs[setting.method] * _work({**values, **setting.values}) * seconds
            timing += cost * grid.rounds
            if not _is_made(results, plan.trajectory(variant, setting)):
                todo.append(cost)
        for run in plan.references(variant):
            if not _is_made(results, run):
                name = run.function.rpartition(':')[2]
                todo.append(costs[name] * _work(dict(run.scene)) * seconds)
    longest = max(todo, default=0.0)
    return EarlyForecast(
        len(todo), max(sum(todo) / max(processes, 1), longest), timing, is_least)


def _is_made(results: ResultsFolder, run: Any) -> bool:
    found = results.find(run.key)
    return found is not None and found.is_final


def _work(values: dict[str, Any]) -> float:
    """Return what the time of a simulated second is in proportion to."""
    try:
        scene = Scene(values)
    except ClothSimError:
        return 0.0  # it will be refused
    if scene['mode'] == 'mass_spring':
        return scene.node_count * choose_substeps(scene) / scene['dt']
    return scene.node_count * scene['refine'] / scene['dt']


def _costs_of_methods(plan: Plan) -> tuple[dict[str, float], bool]:
    """Return the wall time per unit of work of each method and reference [s]."""
    costs: dict[str, float] = {}
    is_least = False
    begin = time.monotonic()
    values = Variant().values(plan.scene)
    for setting in plan.grid.settings:
        if setting.method in costs:
            continue
        own = {**values, **setting.values}
        work = _work(own)
        if time.monotonic() - begin > _PROBES or not work:
            # As expensive as the most expensive known one.
            costs[setting.method] = max(costs.values(), default=0.0)
            is_least |= bool(work)
            continue
        seconds, is_done = _seconds_per_second(own)
        costs[setting.method] = seconds / work
        is_least |= not is_done
    costs['trajectory'] = costs[plan.grid.settings[0].method]
    references = plan.references(Variant())
    if references[0].function.endswith(':spring_reference'):
        costs['spring_reference'] = _reference_cost(dict(references[0].scene))
    costs.setdefault('spring_reference', costs['trajectory'])
    return costs, is_least


def _seconds_per_second(values: dict[str, Any]) -> tuple[float, bool]:
    """Return the wall time of a simulated second [s], and whether a step was finished."""
    try:
        with Simulation(Scene(values)) as cloth:
            begin = time.monotonic()
            # The first step compiles; where it takes too long, its own time has to do.
            if not _step(cloth, begin + _PROBE):
                return (time.monotonic() - begin) / cloth.dt, False
            first = time.monotonic() - begin
            begin, steps = time.monotonic(), 0
            while time.monotonic() < begin + _PROBE and _step(cloth, begin + _PROBE):
                steps += 1
            if not steps:
                return first / cloth.dt, True
            return (time.monotonic() - begin) / (steps * cloth.dt), True
    except ClothSimError:
        return 0.0, True  # it will be refused, or is lost at once


def _step(cloth: Simulation, deadline: float) -> bool:
    """Make a step of dt; return False where it is not done by the ``deadline``."""
    cloth.stepping.aim_steps(1)
    try:
        cloth.work(stop=lambda: time.monotonic() > deadline)
    except StepAbandoned:
        return False
    return True


def _reference_cost(values: dict[str, Any]) -> float:
    scene = Scene(values)
    work = scene.node_count * choose_substeps(scene) / scene['dt']
    cloth = MassSpringReference(scene)
    begin = time.monotonic()
    cloth.step()
    return (time.monotonic() - begin) / scene['dt'] / work
