# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What watching for limits costs a cloth that reaches none, beside mass-spring.

For example:
  python benchmarks/inactive_cost.py
"""

from collections.abc import Iterator
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
import statistics
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import time_steps

MODES = ('mass_spring', 'adaptive')
# A swinging cloth, held along one edge, that stays far from the default limit.
SWINGING = {
    'pins': ['top_edge'],
    'stiffness.structural': 300.0, 'stiffness.shear': 300.0, 'stiffness.bend': 30.0,
    'damping.structural': 1e-5, 'damping.shear': 1e-5, 'damping.bend': 1e-5}


@dataclass(frozen=True)
class InactiveCost:
    """
    Wall time of the same steps in both modes, in turn.

    :param ratio: adaptive over mass_spring, median over the rounds
    :param ratios: of each round
    :param same_state: True when both modes end in the same bits, as they must without a limit
    :param largest_strain: at the end of any round
    """

    nodes: int
    substeps: int
    device: str
    ratio: float
    ratios: tuple[float, ...]
    same_state: bool
    largest_strain: float


def inactive_costs(
        values: Mapping[str, Any], sizes: Sequence[int], rounds: int,
        round_steps: int) -> Iterator[InactiveCost]:
    """
    Yield the cost for cloths of ``sizes`` x ``sizes`` nodes.

    :param values: scene parameters besides rows, cols and mode
    :param rounds: how often each mode has its turn
    :param round_steps: steps of dt in a turn
    """
    for size in sizes:
        context = Context(single_thread=size < 128)
        runs = [
            Simulation(Scene({**values, 'rows': size, 'cols': size, 'mode': mode}),
                       context=context) for mode in MODES]
        for run in runs:
            time_steps(run, round_steps)
        ratios = []
        largest_strain = 0.0
        for _ in range(rounds):
            baseline, watched = (time_steps(run, round_steps) for run in runs)
            ratios.append(watched / baseline)
            largest_strain = max(largest_strain, runs[1].measure().max_strain)
        ends = [run.snapshot() for run in runs]
        yield InactiveCost(
            nodes=size * size, substeps=ends[0].substeps, device=context.device,
            ratio=statistics.median(ratios), ratios=tuple(ratios),
            same_state=ends[0].state_sha256 == ends[1].state_sha256,
            largest_strain=largest_strain)
        for run in runs:
            run.close()
        context.close()


def main() -> None:
    """Print the table of docs/explanation/adaptive.md."""
    print('| nodes | substeps a step | adaptive / mass-spring | rounds | strain | same bits |')
    print('|---|---|---|---|---|---|')
    one_substep = {**SWINGING, 'auto_substeps': False, 'dt': 1e-4}
    for values, sizes, steps in ((SWINGING, (32, 128), 12), (one_substep, (32, 64), 200)):
        for cost in inactive_costs(values, sizes, 9, steps):
            rounds = ' '.join(f'{ratio:.2f}' for ratio in sorted(cost.ratios))
            print(f'| {cost.nodes} | {cost.substeps} | {cost.ratio:.2f} | {rounds} '
                  f'| {cost.largest_strain:.3f} | {cost.same_state} |', flush=True)


if __name__ == '__main__':
    main()
