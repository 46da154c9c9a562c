# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
How the limit holds, and whether energy comes from nowhere, in random scenes with a push.

For example:
  python -m cloth_sim_ros.study.random_limits --first 0 --count 60
"""

from argparse import ArgumentParser
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

_PINS = (['top_left', 'top_right'], ['top_edge'], ['top_left'], ['top_left', 'bottom_right'])


def random_scene(seed: int) -> dict[str, Any]:
    """Return the values of a scene drawn with ``seed``."""
    random = np.random.default_rng(seed)

    def number(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    rows, cols = (int(random.integers(6, 22)) for _ in range(2))
    width, height = number(0.3, 3.0), number(0.3, 3.0)
    values: dict[str, Any] = {
        'mode': 'adaptive', 'rows': rows, 'cols': cols, 'width': width, 'height': height,
        'areal_density': number(0.05, 1.0), 'dt': number(0.005, 0.05),
        'adaptive.threshold': number(0.005, 0.5),
        'start.jitter': float(random.choice([0.0, 0.01])), 'pins': _PINS[random.integers(4)],
        'start.pose': str(random.choice(['horizontal', 'hanging']))}
    stiffness, mass = number(1.0, 300.0), Scene({**values, 'material.preset': 'none'}).node_mass
    shear, bend = random.choice([1.0, 0.3, 0.0]), random.choice([0.1, 1.0, 0.0])
    for family, share in (('structural', 1.0), ('shear', shear), ('bend', bend)):
        ratio = random.choice([0.0, number(0.005, 0.3)])
        values[f'stiffness.{family}'] = float(stiffness * share)
        values[f'damping.{family}'] = float(ratio * share * np.sqrt(stiffness * mass))
    weights = number(0.5, 20.0)
    direction = random.standard_normal(3)
    force = weights * 9.81 * mass * rows * cols * direction / np.linalg.norm(direction)
    return {**values, 'pushes.start': [float(random.uniform(0.2, 1.0))],
            'pushes.duration': [0.2], 'pushes.force': force.tolist()}


def largest_gain(energies: list[float]) -> float:
    """Return by how much energy was at most above what it had been before [J]."""
    if not energies:
        return 0.0
    return float(np.max(np.array(energies) - np.minimum.accumulate(energies)))


def main() -> None:
    """Print a row for each scene."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--first', type=int, default=0, help='seed of the first scene')
    parser.add_argument('--count', type=int, default=60)
    parser.add_argument('--scheme', default='constraint')
    parser.add_argument('--mode', default='adaptive', help='mass_spring to compare with')
    args = parser.parse_args()
    print('| seed | limit | damped | strain / limit | gain of energy / peak kinetic | finite |')
    print('|---|---|---|---|---|---|')
    for seed in range(args.first, args.first + args.count):
        values = {**random_scene(seed), 'adaptive.scheme': args.scheme, 'mode': args.mode}
        begin = values['pushes.start'][0]
        simulation = Simulation(Scene(values))
        strain = kinetic = 0.0
        before, after = [], []
        finite = True
        while finite and simulation.time < begin + 2.2:
            simulation.step()
            snapshot = simulation.snapshot()
            finite = snapshot.finite
            strain = max(strain, snapshot.max_strain)
            kinetic = max(kinetic, snapshot.kinetic_energy)
            if simulation.time < begin:
                before.append(snapshot.total_energy)
            elif simulation.time >= begin + 0.2:
                after.append(snapshot.total_energy)
        gain = max(largest_gain(before), largest_gain(after)) / kinetic
        limit = values['adaptive.threshold']
        damped = values['damping.structural'] > 0.0
        print(f'| {seed} | {limit:.3f} | {damped} | {strain / limit:.2f} | {gain:.4f} '
              f'| {finite} |',
              flush=True)
        simulation.close()


if __name__ == '__main__':
    main()
