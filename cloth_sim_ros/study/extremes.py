# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Run extreme scenes in every mode: each must stay finite, be refused, or stop with a reason.

A row is nonsense if values become non-finite unreported, energy appears without a source, hard
edges have wrong lengths, a free cloth does not fall freely, or a message suggests no remedy. The
exit code is 1 if a row is nonsense or has an unexpected outcome, apart from known limits.

For example:
  cloth_sim study extremes
  cloth_sim study extremes --long --jobs 2 --out studies/extremes
"""

from argparse import ArgumentParser
from argparse import Namespace
from collections import Counter
from collections.abc import Mapping
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import DeviceError
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NonFiniteStateError
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import FAMILIES
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import Snapshot
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.extreme_scenes import Extreme
from cloth_sim_ros.study.extreme_scenes import EXTREMES
from cloth_sim_ros.study.extreme_scenes import OUTCOMES
from cloth_sim_ros.study.extreme_scenes import REFUSED
from cloth_sim_ros.study.extreme_scenes import RUNS
from cloth_sim_ros.study.extreme_scenes import STOPS
from cloth_sim_ros.study.make_runs import make_runs
from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.results import ResultsFolder
from cloth_sim_ros.study.results import Run
from cloth_sim_ros.study.workers import add_run_arguments
from cloth_sim_ros.study.workers import process_context
from cloth_sim_ros.study.workers import workers_of
import numpy as np

# Max. energy gained without work, over the largest kinetic and elastic energy [1].
MOST_GAIN = 0.1
# Max. strain of hard edges [1]; max. strain over the limit [1] (docs/explanation/adaptive.md).
_MOST_HARD_STRAIN = 0.05
_MOST_OVER_LIMIT = 1.5
_NORMAL_ERROR = 1e-4
# Max. error of a free fall, over the distance [1]: float32 and the tolerance of the solver.
_FALL_ERROR = 1e-2
# First words of the advice in an error message.
WAYS_OUT = ('set ', 'take ', 'push ', 'stretch ', 'give ', 'use ', 'go on ')


def message_nonsense(message: str) -> tuple[str, ...]:
    """Return the fault of an error, which has rule, value and remedy in one line."""
    rule, *others = message.split(': ')
    wrong = []
    if not any(character.isdigit() for character in message):
        wrong.append('its message has no value')
    if not rule or not any(other.startswith(WAYS_OUT) for other in others):
        wrong.append('its message has no way out')
    if '\n' in message:
        wrong.append('its message has several lines')
    return tuple(wrong)


def nonsense_of(
        run: Simulation, seen: Snapshot, extreme: Extreme,
        account: EnergyAccount | None = None) -> tuple[str, ...]:
    """
    Return the faults of ``seen``, the end of ``run``.

    :param account: of its energy; None for a run that has stopped
    """
    wrong = _wrong_numbers(run, seen)
    if account is None or wrong:
        return tuple(wrong)
    if not account.gained <= MOST_GAIN and not tells_of(seen):
        wrong.append(f'gains {account.gained:.2g} of its energy from nothing')
    if extreme.holds_lengths:
        wrong += _wrong_lengths(run, seen)
    if not run.scene.pinned_nodes().any() and not extreme.push and not extreme.speed:
        wrong += _wrong_fall(run, seen, account.begin)
    return tuple(wrong)


def tells_of(seen: Snapshot) -> tuple[str, ...]:
    """Return the problems that a snapshot reports, as ~/diagnostics does."""
    told = []
    if seen.stability_margin > 1.0:
        told.append(f'substeps {seen.stability_margin:.2g} times as long as they should be')
    if not seen.lengths_are_held:
        told.append(f'edges off by {seen.max_strain:.2g} of their length')
    if not seen.solver_reached:
        told.append('a solve that did not reach its residual')
    return tuple(told)


def _wrong_numbers(run: Simulation, seen: Snapshot) -> list[str]:
    wrong = []
    if not seen.finite:
        wrong.append('is not finite')
    for name in ('kinetic_energy', 'elastic_energy', 'gravitational_energy', 'max_strain',
                 'positions', 'velocities', 'normals', 'strain'):
        if not np.isfinite(getattr(seen, name)).all():
            wrong.append(f'{name.replace("_", " ")} not finite')
    if not np.abs(np.linalg.norm(seen.normals, axis=-1) - 1.0).max() <= _NORMAL_ERROR:
        wrong.append('normals not of length 1')
    if seen.time != run.steps * run.dt:
        wrong.append('its time is not that of its steps')
    if not run.scene.timed_pin_moves():
        moved = np.abs(seen.velocities[run.scene.pinned_nodes()])
        if moved.size and moved.max() > 0.0:
            wrong.append('pins move')
    return wrong


def _wrong_lengths(run: Simulation, seen: Snapshot) -> list[str]:
    scene = run.scene
    model = AVAILABLE[run.mode].edge_model(scene)
    if model == 'hard':
        hard = set(scene['constraint.hard']) & set(FAMILIES[:2])
        # Strain is that of both structural and shear edges.
        if len(hard) == 2 and not tells_of(seen) and seen.max_strain > _MOST_HARD_STRAIN:
            return [f'hard edges are off by {seen.max_strain:.2g}']
    if model == 'limited' and scene['adaptive.scheme'] != 'paper':
        most = _MOST_OVER_LIMIT * scene['adaptive.threshold']
        if seen.max_strain > most and any(map(scene.models, FAMILIES[:2])):
            return [f'strain {seen.max_strain:.2g} with the limit {scene["adaptive.threshold"]:g}']
    return []


def _wrong_fall(run: Simulation, seen: Snapshot, begin: Snapshot) -> list[str]:
    """Return the fault of the fall of a free cloth: x = t (t + h) g / 2."""
    gravity = np.array(run.scene['gravity'])
    moved = (seen.positions.astype(float) - begin.positions).mean(axis=(0, 1))
    substep = run.dt / run.substeps
    fallen = 0.5 * seen.time * (seen.time + substep) * gravity
    reach = np.abs(begin.positions).max()
    error = np.linalg.norm(moved - fallen)
    if error > _FALL_ERROR * np.linalg.norm(fallen) + 1e-6 * reach:
        return [f'falls {np.linalg.norm(moved):.3g} m instead of {np.linalg.norm(fallen):.3g} m']
    return []


# Run an extreme scene, and check that its result is plausible.

_SEED = 3


@dataclass(frozen=True)
class ExtremeOutcome:
    """
    What came of an extreme scene in one mode.

    :param outcome: runs, refused or stops
    :param detail: strain and energy at the end, or the reason
    :param gained: energy from nothing, over the most kinetic and elastic energy
    :param nonsense: what is wrong with it; empty where nothing is
    """

    outcome: str
    detail: str
    gained: float = 0.0
    nonsense: tuple[str, ...] = ()


def run_by_name(scene: Mapping[str, Any], *, name: str) -> dict[str, Any]:
    """Return what came of the extreme ``name`` in the mode of ``scene``, as plain values."""
    context = process_context()
    outcome = run_extreme(EXTREMES[name], scene['mode'], context)
    return {**vars(outcome), 'nonsense': list(outcome.nonsense), 'device': context.device}


def run_extreme(extreme: Extreme, mode: str, context: Context) -> ExtremeOutcome:
    """Run ``extreme`` in ``mode`` and judge it."""
    try:
        run = Simulation(Scene({
            'rows': 8, 'cols': 8, 'material.preset': 'none', **extreme.values, 'mode': mode}),
            context=context)
    except (ClothSimError, DeviceError) as error:
        return ExtremeOutcome(REFUSED, str(error), nonsense=message_nonsense(str(error)))
    with closing(run):
        try:
            account = _prepare(run, extreme)
            account.step(extreme.steps)
        except NonFiniteStateError as error:
            return ExtremeOutcome(
                STOPS, str(error), nonsense=(
                    *message_nonsense(str(error)), *nonsense_of(run, run.snapshot(), extreme)))
        except ClothSimError as error:
            return ExtremeOutcome(REFUSED, str(error), nonsense=message_nonsense(str(error)))
        seen = account.seen
        detail = (f'strain {seen.max_strain:.2g}, kinetic energy {seen.kinetic_energy:.2g} J, '
                  f'substeps {seen.substeps}')
        gained = account.gained if np.isfinite(account.gained) else 1.0
        if gained > MOST_GAIN:
            detail += f', energy from nothing {gained:.2g}'
        told = tells_of(seen)
        if told:
            detail += f'; reports {" and ".join(told)}'
        return ExtremeOutcome(
            RUNS, detail, gained, nonsense_of(run, seen, extreme, account))


def _prepare(run: Simulation, extreme: Extreme) -> EnergyAccount:
    random = np.random.default_rng(_SEED)
    if extreme.start is not None or extreme.speed:
        rest = run.scene.rest_positions()
        positions = rest if extreme.start is None else extreme.start(rest, random)
        run.set_state(
            positions, random.uniform(-extreme.speed, extreme.speed, rest.shape)
            if extreme.speed else np.zeros_like(positions))
    if extreme.push:
        run.push(**extreme.push)
    return EnergyAccount(run)


# The table of the extremes.

_RIGHT = 'as it should'
_REPORTED = 'reported'
_NONSENSE = 'NONSENSE'
_OTHERWISE = 'OTHERWISE'


def verdict(result: Result) -> str:
    """
    Return whether a row is right, nonsense, or came out otherwise.

    'reported' is a problem that the snapshot and ~/diagnostics report.
    """
    extreme = EXTREMES[result.settings['name']]
    if not result.is_done:
        return _OTHERWISE
    if result.values['nonsense']:
        return _NONSENSE
    if result.values['outcome'] not in extreme.expected:
        return _OTHERWISE
    return _REPORTED if result.values['gained'] > MOST_GAIN else _RIGHT


def is_right(result: Result) -> bool:
    """Return whether a row is right, or reports its problem itself."""
    return verdict(result) in (_RIGHT, _REPORTED)


def extreme_table(results: Sequence[Result]) -> str:
    """Return a row for each scene and mode in Markdown, and how many there are of each kind."""
    lines = [
        '| group | scene | mode | outcome | verdict | detail |', '|---|---|---|---|---|---|']
    for result in results:
        extreme = EXTREMES[result.settings['name']]
        if result.is_done:
            outcome, detail = result.values['outcome'], result.values['detail']
        else:
            outcome, detail = result.outcome, result.reason
        wrong = '; '.join(result.values.get('nonsense', ()))
        lines.append(
            f'| {extreme.group} | {result.settings["name"]} | {result.scene["mode"]} | {outcome} '
            f'| {verdict(result)} | {wrong + "; " if wrong else ""}{detail} |')
    counts = Counter(
        result.values['outcome'] if result.is_done else result.outcome for result in results)
    verdicts = Counter(map(verdict, results))
    lines += ['', f'{len(results)} rows: '
              + ', '.join(f'{counts[outcome]} {outcome}' for outcome in OUTCOMES)
              + f'; {verdicts[_NONSENSE]} nonsense, {verdicts[_OTHERWISE]} otherwise than they '
              f'should, {verdicts[_REPORTED]} gone wrong and reported.']
    return '\n'.join(lines) + '\n'


_FUNCTION = 'cloth_sim_ros.study.extremes:run_by_name'


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments of this study."""
    parser.add_argument('--long', action='store_true',
                        help='also run those that take minutes: a grid of stiffness, mass and dt, '
                             'random scenes, and a million nodes')
    add_run_arguments(parser, 'studies/extremes')


def main(args: Namespace) -> int:
    """Make the runs and write the table."""
    runs = extreme_runs(with_long=args.long)
    folder = Path(args.out)
    with ResultsFolder(folder) as results:
        found = make_runs(runs, results, workers_of(args), title='extremes')
    text = extreme_table(found)
    (folder / 'extremes.md').write_text(text, encoding='utf-8')
    print(text)
    print(f'the table is in {folder / "extremes.md"}')
    return 0 if all(map(is_right, found)) else 1


def extreme_runs(*, with_long: bool) -> list[Run]:
    """Return a run for each extreme and each of its modes."""
    return [
        Run(_FUNCTION, {'mode': mode}, {'name': name})
        for name, extreme in EXTREMES.items() if with_long or not extreme.is_long
        for mode in extreme.modes]
