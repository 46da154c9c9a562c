# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pictures of a camera beside a cloth: wall time of depth, and of colours with depth."""

from collections.abc import Iterator

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from gpu.clock import seconds_each
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np

_SIZES = ((640, 480), (1280, 720))
_SIDE = 64


def _measure(quick: bool) -> Iterator[Row]:
    context = Context()
    with Simulation(Scene({'rows': _SIDE, 'cols': _SIDE}), context=context) as cloth:
        cloth.step(2)
        for width, height in ((64, 48),) if quick else _SIZES:
            with Camera(
                    position=[1.5, 0.0, 1.5], target=[0.0, 0.0, 1.0], width=width,
                    height=height) as camera:
                for has_color in (False, True):
                    def take(has_color: bool = has_color) -> np.ndarray:
                        picture = camera.capture(
                            cloth, color=has_color, labels=False, normals=False, visible=False)
                        assert picture.depth is not None
                        return picture.depth

                    is_same = np.array_equal(take(), take())
                    yield {
                        'picture': f'{width} x {height}',
                        'parts': 'colours and depth' if has_color else 'depth',
                        'ms': 1e3 * seconds_each(take, context),
                        'pixels of cloth': int(np.isfinite(take()).sum()),
                        FAULT: '' if is_same else 'other bits in a second picture'}
    context.close()


SECTION = Section('cameras', 'Cameras', 30.0, _measure)
