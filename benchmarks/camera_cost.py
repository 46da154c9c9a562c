# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Processor time of a picture each 33.3 ms beside a cloth, by what is taken, in interleaved rounds.

    python benchmarks/camera_cost.py
"""

from argparse import ArgumentParser
from collections.abc import Mapping
from collections.abc import Sequence
import statistics
from time import process_time

from cloth_sim_ros import Camera
from cloth_sim_ros import Scene
from cloth_sim_ros import Simulation

_NOTHING: Mapping[str, bool] = {
    'color': False, 'depth': False, 'labels': False, 'normals': False, 'visible': False}
# What is taken of a picture, and the samples of its colours; None: no picture.
PICTURES: Mapping[str, tuple[int, Mapping[str, bool]] | None] = {
    'nothing': None,
    'depth': (4, {**_NOTHING, 'depth': True}),
    'depth and labels': (4, {**_NOTHING, 'depth': True, 'labels': True}),
    'colour and depth': (4, {**_NOTHING, 'color': True, 'depth': True}),
    'colour and depth, `samples: 1`': (1, {**_NOTHING, 'color': True, 'depth': True})}
_STEPS = 10  # of 1 / 300 s a picture


def measure(nodes: int, size: tuple[int, int], rounds: int) -> dict[str, tuple[float, float]]:
    """Return, by what is taken, the time of steps with picture and of the picture alone [s]."""
    scene = Scene({'rows': nodes, 'cols': nodes, 'mode': 'mass_spring', 'dt': 1.0 / 300.0})
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in PICTURES}
    with Simulation(scene) as cloth:
        cameras = {
            name: Camera(
                position=[1.2, 0.0, 1.4], target=[0.0, 0.0, 1.0], width=size[0],
                height=size[1], samples=taken[0])
            for name, taken in PICTURES.items() if taken}
        # A first round compiles.
        for number in range(rounds + 1):
            for name, taken in PICTURES.items():
                begin = process_time()
                cloth.step(_STEPS)
                cloth.finish()
                stepped = process_time()
                if taken:
                    cameras[name].capture(cloth, **taken[1])
                end = process_time()
                if number:
                    found[name].append((end - begin, end - stepped))
        for camera in cameras.values():
            camera.close()
    return {
        name: (statistics.median(all_ for all_, _ in times), statistics.median(
            picture for _, picture in times)) for name, times in found.items()}


def main(arguments: Sequence[str] | None = None) -> None:
    """Print a table."""
    parser = ArgumentParser(description=__doc__)
    parser.add_argument('--nodes', type=int, default=64, help='along a side')
    parser.add_argument('--size', type=int, nargs=2, default=(640, 480), help='[pixel]')
    parser.add_argument('--rounds', type=int, default=8)
    args = parser.parse_args(arguments)
    print('| what is taken | processor time of picture and steps | of the picture |')
    print('|---|---|---|')
    for name, times in measure(args.nodes, tuple(args.size), args.rounds).items():
        print('| ' + ' | '.join([name, *(f'{1e3 * time:.1f} ms' for time in times)]) + ' |')


if __name__ == '__main__':
    main()
