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
from cloth_sim_ros.study.energy_account import EnergyAccount
import numpy as np

# Simulated after the push has begun [s].
_SECONDS_AFTER = 2.2
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


def main() -> None:
    """Print a row for each scene."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--first', type=int, default=0, help='seed of the first scene')
    parser.add_argument('--count', type=int, default=60)
    parser.add_argument('--scheme', default='constraint')
    parser.add_argument('--mode', default='adaptive', help='mass_spring to compare with')
    args = parser.parse_args()
    print('| seed | limit | damped | strain / limit | steps beyond 1.2 that are not reported '
          '| energy gained / most that moved or was elastic | finite |')
    print('|---|---|---|---|---|---|---|')
    for seed in range(args.first, args.first + args.count):
        values = {**random_scene(seed), 'adaptive.scheme': args.scheme, 'mode': args.mode}
        limit = values['adaptive.threshold']
        simulation = Simulation(Scene(values))
        account = EnergyAccount(simulation)
        strain, unreported, is_finite = 0.0, 0, True
        while is_finite and simulation.time < values['pushes.start'][0] + _SECONDS_AFTER:
            snapshot = account.step()
            is_finite = snapshot.finite
            strain = max(strain, snapshot.max_strain)
            unreported += snapshot.max_strain > 1.2 * limit and snapshot.lengths_are_held
        print(f'| {seed} | {limit:.3f} | {values["damping.structural"] > 0.0} '
              f'| {strain / limit:.2f} | {unreported} | {account.gained:.4f} | {is_finite} |',
              flush=True)
        simulation.close()


if __name__ == '__main__':
    main()
