# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
How well the adaptive mode holds its limit, and what it costs.

For example:
  python benchmarks/limits.py
  python benchmarks/limits.py --seconds 4
"""

from argparse import ArgumentParser
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from pushed_scenes import paper_scene
from pushed_scenes import unit_scene

_DTS = (0.01, 0.02, 0.03, 0.05)


@dataclass(frozen=True)
class LimitRun:
    """
    One run, looked at after each dt.

    :param max_strain: the largest of any look
    :param peak_kinetic_energy: [J]
    :param switching: constraints that switched, mean over the steps, over all edges
    :param substeps: in a simulated second
    :param finite: False when it blew up
    """

    max_strain: float
    peak_kinetic_energy: float
    switching: float
    substeps: float
    finite: bool


def limit_run(values: Mapping[str, Any], seconds: float, **options: Any) -> LimitRun:
    """Run a scene for ``seconds`` and return what was seen."""
    simulation = Simulation(Scene(values), **options)
    rows, cols = values['rows'], values['cols']
    edges = rows * (cols - 1) + cols * (rows - 1) + 2 * (rows - 1) * (cols - 1)
    strain, energy, switches, substeps, steps = 0.0, 0.0, 0, 0, 0
    finite = True
    while finite and simulation.time < seconds - 1e-9:
        simulation.step()
        snapshot = simulation.snapshot()
        finite = snapshot.finite
        strain = max(strain, snapshot.max_strain)
        energy = max(energy, snapshot.kinetic_energy)
        switches += snapshot.constraint_switches
        substeps += snapshot.substeps
        steps += 1
    run = LimitRun(
        strain, energy, switches / (edges * steps), substeps / simulation.time, finite)
    simulation.close()
    return run


def spread(runs: Sequence[LimitRun]) -> float:
    """Return how far the largest peak of kinetic energy is above the least."""
    peaks = [run.peak_kinetic_energy for run in runs]
    return max(peaks) / min(peaks) - 1.0


def _row(name: str, runs: Sequence[LimitRun]) -> str:
    strains = ' '.join(f'{run.max_strain:.3f}' for run in runs)
    switching = ' '.join(f'{100.0 * run.switching:.1f}' for run in runs)
    substeps = ' '.join(f'{run.substeps:.0f}' for run in runs)
    return f'| {name} | {strains} | {100.0 * spread(runs):.1f} | {switching} | {substeps} |'


def main() -> None:
    """Print the table of docs/explanation/adaptive.md."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=10.0, help='simulated, of each run')
    args = parser.parse_args()
    dts = ' '.join(f'{dt:g}' for dt in _DTS)
    print(f'| scene | max strain at dt {dts} | spread of peak kinetic energy, % '
          '| edges that switch a step, % | substeps a simulated second |')
    print('|---|---|---|---|---|')
    for name, scene in (
            ('paper P5', lambda **values: paper_scene(5.0, **values)),
            ('paper P20', lambda **values: paper_scene(20.0, **values)),
            ('unit N=12 P5', lambda **values: unit_scene(12, 5.0, **values)),
            ('unit N=12 P20', lambda **values: unit_scene(12, 20.0, **values)),
            ('unit N=32 P5', lambda **values: unit_scene(32, 5.0, **values)),
            ('unit N=32 P20', lambda **values: unit_scene(32, 20.0, **values))):
        runs = [limit_run(scene(dt=dt), args.seconds) for dt in _DTS]
        print(_row(name, runs), flush=True)


if __name__ == '__main__':
    main()
