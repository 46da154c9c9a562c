# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
What a tight strain limit costs on soft springs: a light towel that is shaken at two corners.

Nearly all of its edges come to a limit of 1 % and leave it again, and the solves of a substep have
to find which pull. The options choose how edges are held, and change constants of the law, to see
what decides how many solves it takes.

For example:
  LP_NUM_THREADS=0 python benchmarks/shaken_towel.py
  LP_NUM_THREADS=0 python benchmarks/shaken_towel.py --scheme lattice
  LP_NUM_THREADS=0 python benchmarks/shaken_towel.py --scheme whole --transition 0
  LP_NUM_THREADS=0 python benchmarks/shaken_towel.py --nodes 64 --density 0.2 --seconds 60
"""

from argparse import ArgumentParser
from dataclasses import dataclass
import sys
from time import process_time

from cloth_sim_ros.sim.limits import limit_law
from cloth_sim_ros.sim.modes import implicit
from cloth_sim_ros.sim.modes import limited_springs
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

TOWEL = {
    'mode': 'adaptive', 'adaptive.threshold': 0.01, 'areal_density': 0.05,
    'stiffness.structural': 5.0, 'stiffness.shear': 5.0, 'stiffness.bend': 0.5,
    'damping.structural': 1e-3, 'damping.shear': 1e-3, 'damping.bend': 1e-4, 'dt': 0.01}
# Not timed: shaders are compiled in them.
_FIRST_STEPS = 3
_REACH = 0.05      # [m]
_FREQUENCY = 2.0   # [Hz]


@dataclass(frozen=True)
class Shaking:
    """
    What a run took, per simulated second, substep or solve, and how far edges were strained.

    :param seconds: processor time of a simulated second [s]
    :param substeps: of a dt, mean
    :param listed: share of the substeps in which only the edges near their limit were solved for
    :param whole: share of those in which the whole cloth was
    :param rounds: of a step in which edges were listed, mean of the most in a substep of it
    :param solves: of a substep of the whole cloth, mean
    :param iterations: of a solve, mean
    :param unreached: share of the steps whose ``solver_reached`` was false
    :param largest: strain of any edge after any step
    :param median: over the steps of the last two thirds, of the largest strain
    """

    seconds: float
    substeps: float
    listed: float
    whole: float
    rounds: float
    solves: float
    iterations: float
    unreached: float
    largest: float
    median: float


def shake(seconds: float, *, says_progress: bool = False, **changes: object) -> Shaking:
    """
    Shake the towel for ``seconds`` [s], with ``changes`` of its scene.

    :param says_progress: print the largest strain of each second as soon as it is known
    """
    simulation = Simulation(Scene({**TOWEL, **changes}))
    start = simulation.snapshot().positions.astype(float)
    pins = np.argwhere(simulation.pinned_nodes()).tolist()
    place, begin = np.zeros(3), 0.0
    second = round(1.0 / simulation.dt)
    substeps = listed = whole = solves = unreached = 0
    rounds: list[int] = []
    iterations = 0.0
    strains: list[float] = []
    for step in range(round(seconds / simulation.dt)):
        if step == _FIRST_STEPS:
            begin = process_time()
        angle = 2.0 * np.pi * _FREQUENCY * (step + 1) * simulation.dt
        goal = _REACH * np.array([np.sin(angle), 0.0, 0.5 * (1.0 - np.cos(angle))])
        speed = float(np.linalg.norm(goal - place)) / simulation.dt
        for row, col in pins:
            simulation.move_pin(row, col, start[row, col] + goal, speed)
        place = goal
        simulation.step()
        found = simulation.snapshot()
        assert found.finite
        substeps += found.substeps
        listed += found.listed_substeps
        whole += found.whole_substeps
        if found.listed_substeps:
            rounds.append(found.limit_rounds)
        solves += found.solves or 0
        iterations += (found.solves or 0) * (found.mean_iterations or 0.0)
        unreached += not found.solver_reached
        strains.append(found.max_strain)
        if says_progress and (step + 1) % second == 0:
            print(f't = {found.time:.0f} s: largest strain {max(strains[-second:]):.2%}, '
                  f'{process_time() - begin:.0f} s of a processor so far', file=sys.stderr)
    timed = process_time() - begin
    dt = simulation.dt
    simulation.close()
    return Shaking(
        timed / ((len(strains) - _FIRST_STEPS) * dt), substeps / len(strains), listed / substeps,
        whole / substeps, float(np.mean(rounds or [0])), solves / max(whole, 1),
        iterations / max(solves, 1), unreached / len(strains),
        max(strains), float(np.median(strains[len(strains) // 3:])))


def main() -> None:
    """Print one run."""
    parser = ArgumentParser(description=__doc__.partition('\n\n')[0])
    parser.add_argument('--mode', default='adaptive')
    parser.add_argument(
        '--scheme', default='constraint', choices=('constraint', 'list', 'lattice', 'whole'),
        help='adaptive.scheme')
    parser.add_argument('--nodes', type=int, default=24, help='a side')
    parser.add_argument('--seconds', type=float, default=0.4)
    parser.add_argument(
        '--density', type=float, default=TOWEL['areal_density'], help='[kg/m2]')
    parser.add_argument(
        '--tolerance', type=float, default=0.02, help='twice that of solves with limits')
    parser.add_argument(
        '--beyond', type=float, default=limit_law._SHARE,
        help='of the limit: what an edge that carries the cloth is beyond it')
    parser.add_argument(
        '--transition', type=float, default=limited_springs._TRANSITION,
        help='of that: half the strain, from the limit on, over which it comes into force in '
        'scheme whole')
    parser.add_argument(
        '--most-solves', type=int, default=implicit._MOST_SOLVES, help='in a pass of a substep')
    args = parser.parse_args()
    limit_law._SHARE = args.beyond
    limited_springs._TRANSITION = args.transition
    implicit._MOST_SOLVES = args.most_solves
    found = shake(
        args.seconds, says_progress=True, mode=args.mode, rows=args.nodes, cols=args.nodes,
        areal_density=args.density,
        **{'solver.tolerance': args.tolerance, 'adaptive.scheme': args.scheme})
    print(f'{found.seconds:.1f} s of a processor a simulated second; {found.substeps:.1f} '
          f'substeps a dt, {found.listed:.0%} with listed edges and {found.rounds:.1f} rounds, '
          f'{found.whole:.0%} of the whole cloth and {found.solves:.1f} solves, '
          f'{found.iterations:.1f} iterations a solve; limits not found in '
          f'{found.unreached:.0%} of the steps; largest strain '
          f'{found.largest:.2%}, median {found.median:.2%}')


if __name__ == '__main__':
    main()
