# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Scenes drawn at random over all that can be asked for, in every mode: energy and lengths.

    python benchmarks/random_scenes.py --first 0 --count 60
    python benchmarks/random_scenes.py --seed 20261123 --count 150

Each runs for 3 s, or the time that 1500 dt or 40,000 substeps of springs make, and is ended when
it has taken 20 s of processor time. The books are those of ``EnergyAccount``; lengths are measured
from positions. A row is wrong where energy above what was given, or an edge off its length or
limit, is more than is allowed and the run itself reports nothing.
"""

from argparse import ArgumentParser
from dataclasses import dataclass
import math
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.scene_fields import MODES
from cloth_sim_ros.sim.modes import AVAILABLE
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.energy_account import EnergyAccount
from cloth_sim_ros.study.extremes import tells_of
import numpy as np

_SECONDS = 3.0
_MOST_STEPS = 1500
_MOST_SUBSTEPS = 40_000
_LOOKS = 150
_PATIENCE = 20.0
# Max. energy gained without work, over the largest kinetic and elastic energy [1].
_MOST_GAIN = 0.02
# Settling time of a cloth that starts stretched [s].
_SETTLED = 0.3
_PINS = (['top_left', 'top_right'], ['top_edge'], ['top_left'], ['none'])


@dataclass
class Outcome:
    """
    What came of a scene in one mode.

    :param gained: energy from nothing, over the largest kinetic and elastic energy
    :param off: largest strain of a hard edge over 5 %, or of a limited one over 1.5 limits
    :param unreported: what was wrong at a time at which the run reported nothing
    """

    seconds: float = 0.0
    gained: float = 0.0
    off: float = 0.0
    reported: int = 0
    unreported: str = ''


def draw_scene(seed: int) -> dict[str, Any]:
    """Return the values of the scene drawn with ``seed``, but for its mode."""
    random = np.random.default_rng(seed)

    def number(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    rows, cols = (int(random.integers(1, 25)) for _ in range(2))
    cols = max(cols, 2) if rows == 1 else cols
    width, height = number(0.1, 3.0), number(0.1, 3.0)
    tilt = random.standard_normal(3)
    values: dict[str, Any] = {
        'rows': rows, 'cols': cols, 'width': width, 'height': height,
        'areal_density': number(1e-3, 1e2), 'dt': number(1e-5, 0.1),
        'gravity': (9.81 * tilt / np.linalg.norm(tilt)).tolist(),
        'start.jitter': float(random.choice([0.0, number(1e-3, 0.1)])),
        'start.pose': str(random.choice(['horizontal', 'hanging'])),
        'pins': _PINS[random.integers(4)], 'adaptive.threshold': number(0.005, 0.5)}
    mass = Scene({**values, 'material.preset': 'none'}).node_mass
    stiffness = number(1e-2, 1e6)
    for family in ('structural', 'shear', 'bend'):
        share = float(random.choice([1.0, 0.3, 0.03]))
        values[f'stiffness.{family}'] = stiffness * share
        ratio = random.choice([0.0, number(1e-3, 3.0)])
        values[f'damping.{family}'] = float(ratio * np.sqrt(stiffness * share * mass))
    if random.random() < 0.5:
        weight = 9.81 * mass * rows * cols
        force = number(0.3, 20.0) * weight * random.standard_normal(3)
        # From one dt to another: then its work is its force times what the nodes move by.
        dt = values['dt']
        values.update({
            'pushes.start': [dt * round(random.uniform(0.0, 1.0) / dt)],
            'pushes.duration': [dt * max(1, round(number(0.02, 0.5) / dt))],
            'pushes.force': force.tolist()})
    if values['pins'] != ['none'] and random.random() < 0.3:
        target = Scene(values).rest_positions()[0, 0] + random.uniform(-0.2, 0.2, 3)
        values.update({
            'pin_moves.start': [float(random.uniform(0.0, 0.5))],
            'pin_moves.node': ['top_left'], 'pin_moves.target': target.tolist(),
            'pin_moves.speed': [number(0.05, 1.0)]})
    return values


def run_scene(values: dict[str, Any], context: Context) -> Outcome:
    """Run a scene and return what came of it."""
    run, pieces = Simulation(Scene(values), context=context), 1
    if run.substeps > 1 and run.scene.timed_pin_moves() and not AVAILABLE[run.mode].is_implicit:
        # The force on a pin swings within dt, and its work is found from that at the end.
        pieces = run.substeps
        values = {**values, 'dt': run.dt / pieces}
        run.close()
        run = Simulation(Scene(values), context=context)
    outcome = Outcome()
    try:
        steps = min(_SECONDS / run.dt, _MOST_STEPS * pieces)
        if not AVAILABLE[run.mode].is_implicit:
            steps = min(steps, _MOST_SUBSTEPS / run.substeps)
        steps = max(1, math.floor(steps))
        account = EnergyAccount(run)
        done = 0
        end = time.process_time() + _PATIENCE
        while done < steps and time.process_time() < end:
            some = min(max(1, steps // _LOOKS), steps - done)
            account.step(some)
            done += some
            _judge(run, account, outcome)
        outcome.seconds = run.time
    finally:
        run.close()
    return outcome


def _judge(run: Simulation, account: EnergyAccount, outcome: Outcome) -> None:
    off = _off(run, account.seen.positions.astype(float))
    if run.time < _SETTLED and run.scene['start.jitter'] > 0.0:
        off = 0.0
    outcome.off = max(outcome.off, off)
    is_gain = account.gained > max(_MOST_GAIN, outcome.gained)
    outcome.gained = max(outcome.gained, account.gained)
    if not is_gain and off <= 1.0:
        return
    if tells_of(account.seen):
        outcome.reported += 1
    elif not outcome.unreported:
        outcome.unreported = f'gained {account.gained:.2g}, off {off:.2g} at {run.time:.3f} s'


def _off(run: Simulation, positions: np.ndarray) -> float:
    """Return the largest strain of short edges over what is allowed; 0 where all is allowed."""
    model = AVAILABLE[run.mode].edge_model(run.scene)
    if model == 'springs':
        return 0.0
    allowed = 0.05 if model == 'hard' else max(0.05, 1.5 * run.scene['adaptive.threshold'])
    strain = 0.0
    for kind in EDGE_KINDS[:4]:
        starts, ends = kind.everywhere(run.scene.rows, run.scene.cols)
        lengths = np.linalg.norm(positions[ends] - positions[starts], axis=-1)
        if lengths.size:
            strain = max(strain, np.abs(lengths / kind.rest_length(run.scene) - 1.0).max())
    return strain / allowed


def main() -> None:
    """Print a row for each scene and mode."""
    parser = ArgumentParser(description=__doc__.splitlines()[1])
    parser.add_argument('--first', type=int, default=0, help='seed of the first scene')
    parser.add_argument('--seed', type=int, help='draws the seeds of the scenes')
    parser.add_argument('--count', type=int, default=60)
    parser.add_argument('--modes', nargs='+', choices=MODES, default=MODES)
    args = parser.parse_args()
    seeds = range(args.first, args.first + args.count)
    if args.seed is not None:
        seeds = np.random.default_rng(args.seed).integers(2**31, size=args.count).tolist()
    context = Context(single_thread=True)
    print('| seed | nodes | dt | mode | seconds | gained | off | times reported | unreported |')
    print('|---|---|---|---|---|---|---|---|---|')
    runs = wrong = refused = 0
    for seed in seeds:
        for mode in args.modes:
            values = {**draw_scene(seed), 'mode': mode}
            name = f'| {seed} | {values["rows"]} x {values["cols"]} | {values["dt"]:.2g} | {mode}'
            try:
                outcome = run_scene(values, context)
            except ClothSimError as error:
                refused += 1
                print(f'{name} | refused: {error} |', flush=True)
                continue
            runs += 1
            wrong += bool(outcome.unreported)
            print(f'{name} | {outcome.seconds:.3f} | {outcome.gained:.4f} | {outcome.off:.2f} '
                  f'| {outcome.reported} | {outcome.unreported} |', flush=True)
    print(f'\n{runs} runs, {refused} refused, {wrong} wrong.')


if __name__ == '__main__':
    main()
