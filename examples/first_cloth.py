# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
See a cloth fall and swing, in numbers. Needs no ROS.

    python examples/first_cloth.py
    python examples/first_cloth.py --seconds 5
"""

from argparse import ArgumentParser

from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation


def main() -> None:
    """Advance a square metre of cloth that two corners hold, and print its state."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--seconds', type=float, default=1.0, help='simulated time')
    seconds = parser.parse_args().seconds

    scene = Scene({'rows': 32, 'cols': 32, 'pins': ['top_left', 'top_right']})
    with Simulation(scene) as cloth:
        print('time [s]  lowest node [m]  largest strain  kinetic energy [J]')
        while cloth.time < seconds - cloth.dt / 2:
            cloth.advance(min(0.1, seconds - cloth.time))
            lowest = cloth.positions()[..., 2].min()
            now = cloth.measure()
            print(f'{cloth.time:8.2f}  {lowest:15.3f}  {now.max_strain:13.2%} '
                  f'{now.kinetic_energy:19.3f}')


if __name__ == '__main__':
    main()
