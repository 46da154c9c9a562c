# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Measure what a panel of a picture costs: `python -m cloth_sim_ros.rendering.render_cost`.

Sizes of cloth and of detail take turns, so that what else runs on the machine slows all alike.
"""

from collections.abc import Sequence
from statistics import median
import time

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.cloth_drawing import surface_normals
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.renderer import Renderer
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import numpy as np

SIDES = (64, 512)
_SIZE = (1280, 720)


def main(sides: Sequence[int] = SIDES, rounds: int = 9) -> None:
    """Print the table."""
    renderers = {(side, detail): _renderer(side, detail) for side in sides for detail in (1, 2)}
    walls: dict[tuple[int, int], list[float]] = {key: [] for key in renderers}
    processor: dict[tuple[int, int], list[float]] = {key: [] for key in renderers}
    for _ in range(rounds):
        for key, (renderer, frame) in renderers.items():
            begin, busy = time.perf_counter(), time.process_time()
            renderer.draw(frame)
            walls[key].append(time.perf_counter() - begin)
            # Time of all threads of this process, which includes a software device.
            processor[key].append(time.process_time() - busy)
    base = next(iter(walls.values()))
    print(f'{next(iter(renderers.values()))[0].device}, {_SIZE[0]} x {_SIZE[1]} pixels')
    print('nodes        detail    wall [ms]   processor [ms]   wall over the first, by rounds')
    for (side, detail), values in walls.items():
        over = median(value / first for value, first in zip(values, base))
        print(f'{f"{side} x {side}":12} {detail:6} {1e3 * median(values):12.0f}'
              f'{1e3 * median(processor[side, detail]):17.0f} {over:10.2f}')
    for renderer, _ in renderers.values():
        renderer.close()


def _renderer(side: int, detail: int) -> tuple[Renderer, Frame]:
    frame = wavy_cloth(side)
    survey = Survey()
    survey.add(frame)
    view = Camera().looking_at(survey.points, *_SIZE)
    renderer = Renderer(survey, StrainScale(survey.strains), view, detail)
    # Shaders are compiled, and memory is allocated, before it counts.
    renderer.draw(frame)
    return renderer, frame


def wavy_cloth(side: int) -> Frame:
    """Return a square metre in folds, ``side`` nodes along each side."""
    records = np.zeros((side, side), POINT_DTYPE)
    place = np.linspace(-0.5, 0.5, side)
    records['x'] = place
    records['z'] = -place[:, None]
    records['y'] = 0.05 * np.sin(25.0 * place) * (0.5 + place[:, None])
    positions = np.stack([records[axis] for axis in 'xyz'], axis=-1).astype(float)
    for number, axis in enumerate('xyz'):
        records[f'normal_{axis}'] = surface_normals(positions)[..., number]
    records['strain'] = 0.05 * (0.5 - place[:, None])
    return Frame(0.0, records)


if __name__ == '__main__':
    main()
