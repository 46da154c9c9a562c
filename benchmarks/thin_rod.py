# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Time of a substep on a rod of half a cell below a line of nodes, with edges and faces and without.

    LP_NUM_THREADS=0 python benchmarks/thin_rod.py --nodes 17 64
    LP_NUM_THREADS=0 python benchmarks/thin_rod.py --nodes 17 64 --mode constraint
"""

import argparse
from time import process_time

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros.sim.model.scene_fields import MODES

_SIDE = 0.5
_STEPS = 5


def scene_of(nodes: int, mode: str, *, features: bool) -> Scene:
    """Return a cloth that hangs from its top edge, with a rod 0.5 mm below its middle."""
    radius = 0.5 * _SIDE / (nodes - 1)
    return Scene({
        'mode': mode, 'rows': nodes, 'cols': nodes, 'width': _SIDE, 'height': _SIDE,
        'pins': ['top_edge'], 'material.preset': 'trousers', 'start.z': 0.0,
        'dt': 0.005 if mode == 'constraint' else 0.001, 'contact.features': features,
        'colliders.names': ['rod'], 'colliders.rod.shape': 'capsule',
        'colliders.rod.size': [radius, 2.0],
        'colliders.rod.position': [0.0, 0.0, -radius - 0.0005],
        'colliders.rod.orientation': [0.5**0.5, 0.0, 0.0, 0.5**0.5]})


def main() -> None:
    """Print the least processor time of both, in turns."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, nargs='+', default=[64])
    parser.add_argument('--mode', choices=MODES, default='mass_spring')
    parser.add_argument('--settle', type=int, default=20, help='steps of dt before the first')
    parser.add_argument('--rounds', type=int, default=8)
    given = parser.parse_args()
    for nodes in given.nodes:
        runs = [
            Simulation(scene_of(nodes, given.mode, features=features))
            for features in (False, True)]
        for run in runs:
            run.step(given.settle)
        times: list[list[float]] = [[], []]
        for _ in range(given.rounds):
            for run, measured in zip(runs, times):
                run.finish()
                begin = process_time()
                run.step(_STEPS)
                run.finish()
                measured.append((process_time() - begin) / _STEPS / run.substeps)
        without, with_them = (min(measured) for measured in times)
        print(f'{nodes} x {nodes}, {given.mode}: nodes alone {1e3 * without:.3f} ms a substep, '
              f'with edges and faces {1e3 * with_them:.3f} ms, {with_them / without:.1f} x',
              flush=True)
        for run in runs:
            run.close()


if __name__ == '__main__':
    main()
