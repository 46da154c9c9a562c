# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What a looser or tighter tolerance of the solver changes of a run, beside what its steps change.

The light cloth of `cloth_sim bench --modes` falls in mode constraint, and is compared with the
same in steps a sixth as long, solved to 1e-4. Cloth is chaotic after a second: it ends before.

For example:
  python benchmarks/tolerances.py
  python benchmarks/tolerances.py --nodes 64 --tolerances 0.002 0.005
"""

from argparse import ArgumentParser
from collections.abc import Mapping
from collections.abc import Sequence
from dataclasses import dataclass
import math
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.mode_runs import edge_stretch
from cloth_sim_ros.study.mode_runs import LIGHT_CLOTH
import numpy as np

TIMES = (0.2, 0.4, 0.6, 0.8)
_FINE = {'refine': 6, 'solver.tolerance': 1e-4, 'solver.max_iterations': 200,
         'constraint.max_substeps': 400}


@dataclass(frozen=True)
class Fall:
    """
    A run of the light cloth.

    :param positions: [m] at ``TIMES``, each (rows, cols, 3)
    :param iterations: a simulated second
    :param peak_stretch: largest of an edge, at the end of any dt
    """

    positions: list[np.ndarray]
    iterations: float
    peak_stretch: float


def run(nodes: int, **changes: Any) -> Fall:
    """Let the light cloth of ``nodes`` x ``nodes`` fall, with ``changes`` of its scene."""
    values: Mapping[str, Any] = {
        **LIGHT_CLOTH, 'rows': nodes, 'cols': nodes, 'mode': 'constraint',
        'constraint.strain': 0.006, 'dt': 0.02, **changes}
    simulation = Simulation(Scene(values))
    positions, iterations, peak = [], 0.0, 0.0
    for time in TIMES:
        while simulation.time < time - 1e-9:
            simulation.step()
            done = simulation.snapshot()
            iterations += done.solves * done.mean_iterations
            peak = max(peak, edge_stretch(simulation.scene, done.positions).max())
        positions.append(done.positions.astype(float))
    simulation.close()
    return Fall(positions, iterations / TIMES[-1], peak)


def distances(first: Sequence[np.ndarray], second: Sequence[np.ndarray]) -> list[float]:
    """Return the RMS distance of the nodes at each of the times [m]."""
    return [
        math.sqrt(((one - other)**2).sum(axis=-1).mean()) for one, other in zip(first, second)]


def main() -> None:
    """Print a table."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, default=32)
    parser.add_argument('--tolerances', type=float, nargs='+',
                        default=[1e-4, 0.002, 0.005, 0.01, 0.02])
    args = parser.parse_args()
    exact = run(args.nodes, **_FINE)
    print('| `solver.tolerance` | RMS distance [mm] at ' + ', '.join(map(str, TIMES))
          + ' s | peak stretch [%] | iterations a second |')
    print('|---|---|---|---|')
    for tolerance in args.tolerances:
        fall = run(args.nodes, **{'solver.tolerance': tolerance})
        off = ', '.join(
            f'{1e3 * each:.1f}' for each in distances(fall.positions, exact.positions))
        print(f'| {tolerance:g} | {off} | {100.0 * fall.peak_stretch:.2f} '
              f'| {fall.iterations:,.0f} |', flush=True)


if __name__ == '__main__':
    main()
