# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What pictures of a camera cost beside a cloth, by what is taken, in interleaved rounds."""

from collections.abc import Iterator
from collections.abc import Mapping
from dataclasses import asdict
from dataclasses import dataclass
import statistics
from time import process_time
from typing import Any

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation

NO_PICTURE = 'nothing'
# What is taken of a picture: samples of its colours and parts; None: no picture.
PICTURES: Mapping[str, tuple[int, tuple[str, ...]] | None] = {
    NO_PICTURE: None, 'depth': (4, ('depth',)), 'depth and labels': (4, ('depth', 'labels')),
    'colour and depth': (4, ('color', 'depth')),
    'colour and depth, `samples: 1`': (1, ('color', 'depth'))}
# Time between two pictures [s], 30 a second, and steps of dt in it [1].
_FRAME = 1.0 / 30.0
_STEPS = 10


@dataclass(frozen=True)
class CameraSpeed:
    """
    Processor time of pictures of one kind.

    :param taken: one of PICTURES
    :param nodes: of the cloth, along each side
    :param size: of a picture, width and height [pixel]
    :param picture: processor time of a picture in each round [s]
    :param ratios: of steps and picture together to the steps without any, round by round
    """

    taken: str
    nodes: int
    size: tuple[int, int]
    device: str
    picture: list[float]
    ratios: list[float]

    def as_dict(self) -> dict[str, Any]:
        """Return it for JSON."""
        return asdict(self)

    def in_words(self) -> str:
        """Return a line for people."""
        return (
            f'{self.taken}, {self.size[0]} x {self.size[1]} pixels beside {self.nodes} x '
            f'{self.nodes} nodes: {1e3 * statistics.median(self.picture):.2f} ms of a processor, '
            f'{statistics.median(self.ratios):.2f} x the steps of {1e3 * _FRAME:.1f} ms alone '
            f'({min(self.ratios):.2f} to {max(self.ratios):.2f})')


def measure_camera(
        nodes: int, rounds: int, size: tuple[int, int] = (640, 480)) -> Iterator[CameraSpeed]:
    """
    Yield the cost of each kind of picture, one after each 33.3 ms of a cloth in mode mass_spring.

    :param nodes: along each side
    :param size: width and height [pixel]
    """
    scene = Scene(
        {'rows': nodes, 'cols': nodes, 'mode': 'mass_spring', 'dt': _FRAME / _STEPS})
    whole: dict[str, list[float]] = {name: [] for name in PICTURES}
    pictures: dict[str, list[float]] = {name: [] for name in PICTURES}
    with Simulation(scene) as cloth:
        device = cloth.device
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
                    cameras[name].capture(
                        cloth, color='color' in taken[1], depth='depth' in taken[1],
                        labels='labels' in taken[1], normals=False, visible=False)
                end = process_time()
                if number:
                    whole[name].append(end - begin)
                    pictures[name].append(end - stepped)
        for camera in cameras.values():
            camera.close()
    for name in PICTURES:
        yield CameraSpeed(
            name, nodes, size, device, pictures[name],
            [taken / alone for taken, alone in zip(whole[name], whole[NO_PICTURE])])
