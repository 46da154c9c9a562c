# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Make a towel of your own size and weight, push it, and write its shape. Needs no ROS.

    python examples/own_towel.py --width 0.5 --height 0.9 --weight 0.35 --out towel.npz
    cloth_sim render towel.npz --out towel.png
"""

from argparse import ArgumentParser

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
import numpy as np


def main() -> None:
    """Hang the towel by its upper corners, push it in the middle, and write what comes of it."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--width', type=float, default=0.5, help='along the upper edge [m]')
    parser.add_argument('--height', type=float, default=0.9, help='[m]')
    parser.add_argument('--weight', type=float, default=0.35, help='of the dry towel [kg]')
    parser.add_argument('--seconds', type=float, default=1.5, help='simulated time')
    parser.add_argument('--out', default='towel.npz', help='positions, strain and flags')
    args = parser.parse_args()

    spacing = 0.025  # [m]
    scene = Scene({
        'width': args.width, 'height': args.height, 'start.pose': 'hanging',
        'areal_density': args.weight / (args.width * args.height),
        'cols': round(args.width / spacing) + 1, 'rows': round(args.height / spacing) + 1,
        'stiffness.structural': 1000.0, 'stiffness.shear': 200.0,
        'pins': ['top_left', 'top_right']})
    with Simulation(scene) as towel:
        middle = towel.positions()[scene.rows // 2, scene.cols // 2]
        push = towel.push(
            (0.0, 3.0, 0.0), duration=0.3, region='sphere', center=middle, radius=0.15)
        print(f'{scene.rows} x {scene.cols} nodes, {scene.mass:.3f} kg, '
              f'{push.nodes} of them pushed')
        towel.advance(args.seconds)
        last = towel.snapshot()
    np.savez(args.out, positions=last.positions, strain=last.strain, flags=last.flags,
             time=last.time)
    print(f'largest strain {last.max_strain:.2%}; written to {args.out}')


if __name__ == '__main__':
    main()
