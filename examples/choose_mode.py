# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Choose a mode by how far the cloth may stretch: the fastest one within the budget. Needs no ROS.

    python examples/choose_mode.py --budget 0.02
    python examples/choose_mode.py config/drape.yaml --budget 0.05 --seconds 2
"""

from argparse import ArgumentParser
import time

from cloth_sim_ros import load_scene
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation

FRAME = 0.02  # [s]


def measure(scene: Scene, seconds: float) -> tuple[float, float]:
    """Return the largest strain of all frames, and simulated over wall time."""
    with Simulation(scene) as cloth:
        cloth.warm_up()
        peak, begin = 0.0, time.perf_counter()
        while cloth.time < seconds:
            cloth.advance(FRAME)
            peak = max(peak, cloth.measure().max_strain)
        return peak, cloth.time / (time.perf_counter() - begin)


def main() -> None:
    """Run the scene in each mode and print what it costs and how far it stretches."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('scene', nargs='?', help='parameter file; a swinging cloth by default')
    parser.add_argument('--budget', type=float, default=0.02, help='largest strain allowed')
    parser.add_argument('--seconds', type=float, default=1.0, help='simulated time')
    args = parser.parse_args()

    within = {}
    for mode in ('mass_spring', 'constraint', 'adaptive'):
        # A long dt, which each mode splits into the substeps that it needs.
        changes = {
            'mode': mode, 'dt': FRAME, 'adaptive.threshold': max(0.6 * args.budget, 0.005)}
        scene = load_scene(args.scene, changes) if args.scene else Scene(changes)
        strain, factor = measure(scene, args.seconds)
        print(f'{mode:12} largest strain {strain:7.2%}, {factor:6.2f} x real time')
        if strain <= args.budget:
            within[mode] = factor
    if within:
        print(f'choose {max(within, key=lambda mode: within[mode])}')
    else:
        print('no mode keeps to the budget: allow more, or set a smaller constraint.strain')


if __name__ == '__main__':
    main()
