# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

r"""
How still the force at the pins is in mode adaptive, when the cloth should hang still at its limit.

For example:
  python benchmarks/force_tremor.py --seconds 20
"""

from argparse import ArgumentParser
from collections.abc import Mapping
from contextlib import closing
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np

_STEPS = 300
_DTS = (0.002, 0.01, 0.02)
_HELD = {'mode': 'adaptive', 'start.pose': 'hanging', 'stiffness.bend': 0.0, 'damping.bend': 0.0}
# Springs so soft that the limit carries the cloth, and strongly damped.
SCENES = {
    'chain of 15 nodes, limit 2 %': {
        **_HELD, 'rows': 15, 'cols': 1, 'node_mass': 0.01, 'pins': ['top_edge'],
        'stiffness.structural': 50.0, 'damping.structural': 0.3, 'adaptive.threshold': 0.02,
        'dt': 0.002},
    '15 x 4 nodes, limit 2 %': {
        **_HELD, 'rows': 15, 'cols': 4, 'width': 0.3, 'node_mass': 0.01, 'pins': ['top_edge'],
        'stiffness.structural': 50.0, 'damping.structural': 0.3, 'stiffness.shear': 50.0,
        'damping.shear': 0.3, 'adaptive.threshold': 0.02, 'dt': 0.002},
    '12 x 12 nodes on two corners, limit 10 %': {
        **_HELD, 'rows': 12, 'cols': 12, 'stiffness.structural': 5.0, 'stiffness.shear': 5.0,
        'dt': 0.01},
    '32 x 32 nodes on two corners, damped, limit 10 %': {
        **_HELD, 'rows': 32, 'cols': 32, 'areal_density': 0.2, 'material.preset': 'none',
        'stiffness.structural': 5.0, 'stiffness.shear': 5.0, 'damping.structural': 0.05,
        'damping.shear': 0.05, 'dt': 0.01},
}


def tremor(values: Mapping[str, Any], seconds: float) -> tuple[float, float, float, float]:
    """
    Return mean and standard deviation of the vertical force at the pins, and what moves.

    :param seconds: given to the cloth to come to rest; what follows is looked at, step by step
    :return: the forces over the weight, how far nodes move [m], and the edges that come to their
        limit or leave it in a step over those at it [1]
    """
    with closing(Simulation(Scene(values))) as simulation:
        simulation.advance(seconds)
        # Switches count from the last snapshot on.
        simulation.snapshot()
        forces, positions, switches, held = [], [], 0, 0
        for _ in range(_STEPS):
            simulation.step()
            snapshot = simulation.snapshot(pin_forces=True)
            forces.append(-snapshot.pin_forces.forces[:, 2].sum())
            positions.append(snapshot.positions)
            switches += snapshot.constraint_switches
            held += snapshot.active_constraints
        scene = simulation.scene
    weight = -scene.mass * scene['gravity'][2]
    moved = np.ptp(np.stack(positions), axis=0).max()
    return (
        float(np.mean(forces) / weight), float(np.std(forces) / weight), float(moved),
        switches / max(held, 1))


def main() -> None:
    """Print the table of docs/explanation/adaptive.md."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=10.0, help='simulated before the look')
    args = parser.parse_args()
    print('| scene | dt | mean force / weight | standard deviation / weight | nodes move [m] '
          '| switches a step / edges held |')
    print('|---|---|---|---|---|---|')
    for name, values in SCENES.items():
        for dt in _DTS:
            mean, deviation, moved, switching = tremor({**values, 'dt': dt}, args.seconds)
            print(f'| {name} | {dt:g} | {mean:.4f} | {deviation:.1e} | {moved:.1e} '
                  f'| {switching:.1e} |', flush=True)


if __name__ == '__main__':
    main()
