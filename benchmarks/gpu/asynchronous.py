# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What overlaps with the device's work gives the bits of what waits for it."""

from collections.abc import Iterator
from threading import Thread

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np

_FRAMES = 20


def _scene(mode: str, side: int) -> Scene:
    return Scene({'mode': mode, 'rows': side, 'cols': side, 'start.jitter': 0.01})


def _snapshots(scene: Scene, context: Context, *, later: bool) -> list[np.ndarray]:
    """Return the records of some frames; ``later`` reads each while the next is computed."""
    found = []
    with Simulation(scene, context=context) as cloth:
        for _ in range(_FRAMES):
            cloth.step(2)
            if later:
                finish = cloth.begin_snapshot()
                cloth.step(1)
                found.append(finish().records)
            else:
                found.append(cloth.snapshot().records)
                cloth.step(1)
    return found


def _prepared(side: int, context: Context) -> tuple[np.ndarray, np.ndarray]:
    """Return the positions after a mode was compiled here, and in a second context beside."""
    found = []
    for is_prepared in (False, True):
        with Simulation(_scene('mass_spring', side), context=context) as cloth:
            cloth.step(10)
            if is_prepared:
                preparation = cloth.engines.preparation('constraint')
                thread = Thread(target=preparation.run)
                thread.start()
                thread.join()
                if preparation.error:
                    raise preparation.error
                cloth.take_over(preparation)
            else:
                cloth.set_mode('constraint')
            cloth.step(10)
            found.append(cloth.positions())
    return found[0], found[1]


def _measure(quick: bool) -> Iterator[Row]:
    context = Context(single_thread=True)
    for mode in ('mass_spring', 'constraint', 'adaptive'):
        for side in (24,) if quick else (24, 128):
            pairs = zip(*(_snapshots(_scene(mode, side), context, later=later)
                          for later in (False, True)))
            unlike = sum(now.tobytes() != later.tobytes() for now, later in pairs)
            yield {'way': 'begin_snapshot', 'mode': mode, 'side': side, 'frames': _FRAMES,
                   'frames with other bits': unlike,
                   FAULT: 'other bits' if unlike else ''}
    now, beside = _prepared(24, context)
    unlike = int(not np.array_equal(now, beside))
    yield {'way': 'compiled in a second context', 'mode': 'constraint', 'side': 24, 'frames': 1,
           'frames with other bits': unlike, FAULT: 'other bits' if unlike else ''}
    context.close()


SECTION = Section('asynchronous', 'Overlapping work', 40.0, _measure)
