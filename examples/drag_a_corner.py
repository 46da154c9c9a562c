# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Drag a corner of a cloth and read the force that it takes. Needs no ROS.

    python examples/drag_a_corner.py
    python examples/drag_a_corner.py --speed 2 --max-force 3
"""

from argparse import ArgumentParser

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
import numpy as np


def main() -> None:
    """Let the cloth hang, pull its lower left corner to the side, and print the force."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--speed', type=float, default=0.5, help='of the corner [m/s]')
    parser.add_argument('--max-force', type=float, default=0.0,
                        help='pull at which the corner stands still [N]; 0 for none')
    args = parser.parse_args()

    scene = Scene({
        'rows': 24, 'cols': 24, 'start.pose': 'hanging', 'mode': 'constraint',
        'pins': ['top_edge'], 'pin.max_force': args.max_force})
    with Simulation(scene) as cloth:
        cloth.advance(0.2)
        row, col = scene.rows - 1, 0
        cloth.pin(row, col)
        start = cloth.positions()[row, col]
        target = start + np.array([0.1, 0.5, 0.3])
        arrival = cloth.move_pin(row, col, target, speed=args.speed).arrival
        print('time [s]  moved [m]  force on the gripper x, y, z [N]')
        while cloth.time < arrival + 0.1:
            cloth.advance(0.1)
            now, held = cloth.snapshot(), cloth.pin_forces()
            corner = np.flatnonzero((held.nodes == (row, col)).all(axis=1))[0]
            moved = np.linalg.norm(now.positions[row, col] - start)
            print(f'{now.time:8.2f}  {moved:9.3f}  '
                  + ' '.join(f'{part:8.3f}' for part in held.forces[corner])
                  + ('  stands still' if now.stalled_pins else ''))


if __name__ == '__main__':
    main()
