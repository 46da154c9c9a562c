# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What it costs to check that the state stays finite, beside steps without a check.

For example:
  python benchmarks/guard_cost.py
"""

from collections.abc import Iterator
from collections.abc import Sequence
from dataclasses import dataclass
import statistics
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import bench_scene


@dataclass(frozen=True)
class GuardCost:
    """
    Wall time of the same steps, in turn, with the check over that without.

    :param batch: steps of one substep in each call of step, which ends with a check
    :param ratio: median over the rounds
    :param ratios: of each round
    """

    size: int
    batch: int
    device: str
    ratio: float
    ratios: tuple[float, ...]


def guard_costs(
        sizes: Sequence[int], batches: Sequence[int], rounds: int,
        round_node_steps: float) -> Iterator[GuardCost]:
    """
    Yield the cost for cloths of size x size nodes and each batch.

    :param round_node_steps: steps of a turn times nodes
    """
    for size in sizes:
        context = Context(single_thread=size < 128)
        scene = bench_scene(size, {})
        runs = [
            Simulation(scene, context=context, stop_at_non_finite=guarded)
            for guarded in (True, False)]
        for batch in batches:
            calls = max(1, round(round_node_steps / (size * size * batch)))
            for run in runs:
                _time_calls(run, calls, batch)
            ratios = []
            for _ in range(rounds):
                guarded, bare = (_time_calls(run, calls, batch) for run in runs)
                ratios.append(guarded / bare)
            yield GuardCost(
                size, batch, context.device, statistics.median(ratios), tuple(ratios))
        for run in runs:
            run.close()
        context.close()


def _time_calls(run: Simulation, calls: int, batch: int) -> float:
    run.finish()
    begin = time.perf_counter()
    for _ in range(calls):
        run.step(batch)
    run.finish()
    return time.perf_counter() - begin


def main() -> None:
    """Print the table of docs/notes/performance.md."""
    print('| nodes | substeps in a batch | with the check / without | rounds |')
    print('|---|---|---|---|')
    for cost in guard_costs((32, 128, 512), (1, 16, 64), 15, 1.5e7):
        print(
            f'| {cost.size} x {cost.size} | {cost.batch} | {cost.ratio:.3f} | '
            f'{min(cost.ratios):.2f} to {max(cost.ratios):.2f} |', flush=True)


if __name__ == '__main__':
    main()
