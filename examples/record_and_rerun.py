# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Record a run as mcap, make it again bit for bit, and once more with a stiffer cloth.

    python examples/record_and_rerun.py --out bags
    cloth_sim info bags/pushed
"""

from argparse import ArgumentParser

from cloth_sim_ros import resimulate
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation
from cloth_sim_ros import SimulationRecorder


def main() -> None:
    """Push a cloth, switch its mode, and compare what comes of the same inputs."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--out', default='bags', help='folder of the recording')
    parser.add_argument('--name', default='pushed', help='of the recording')
    parser.add_argument('--seconds', type=float, default=1.0, help='simulated time')
    args = parser.parse_args()

    with Simulation(Scene({'rows': 24, 'cols': 24})) as cloth:
        with SimulationRecorder(cloth, args.out, args.name) as recorder:
            recorder.advance(args.seconds / 2)
            cloth.push((0.0, 0.5, 1.0), duration=0.2)
            cloth.set_mode('constraint')
            recorder.advance(args.seconds / 2)
    print(f'recorded into {recorder.path}')

    again = resimulate(recorder.path)
    print('\n'.join(again.lines()))

    print('with another stiffness:')
    stiffer = resimulate(recorder.path, {'material.warp': 4000.0})
    print('\n'.join(stiffer.lines()))


if __name__ == '__main__':
    main()
