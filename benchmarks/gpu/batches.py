# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Many cloths that step together in a Batch."""

from collections.abc import Iterator
from collections.abc import Mapping
from contextlib import closing
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.batch import Batch
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.study.speed import bench_scene
from gpu.section import FAULT
from gpu.section import Row
from gpu.section import Section
import numpy as np


def _scenes(side: int, count: int) -> list[Scene]:
    values = bench_scene(side, {}).values
    return [Scene({**values, 'start.seed': number}) for number in range(count)]


_FABRIC = {'rows': 11, 'cols': 9, 'start.jitter': 0.02}
_PUSHED = {
    **_FABRIC, 'start.pose': 'horizontal', 'start.z': 0.2, 'colliders.names': ['ball', 'box'],
    'colliders.ball.size': [0.15], 'colliders.box.shape': 'box',
    'colliders.box.size': [0.2, 0.3, 0.2], 'colliders.box.position': [0.3, 0.0, 0.0]}


def _first_unlike_step(values: Mapping[str, Any], most: int, *, moves: bool) -> int | None:
    """
    Return the first step in which a fabric in air has other bits in a Batch than alone.

    :param moves: whether the ball and the box of each cloth move and turn, at their own speeds
    """
    scenes = [Scene({**values, 'start.seed': seed}) for seed in range(3)]
    with Batch(scenes) as batch, Simulation(scenes[1]) as alone:
        for name in ('ball', 'box') if moves else ():
            targets = np.array([[0.1, 0.1, 0.1 * cloth] for cloth in range(3)])
            turned = np.tile([0.0, 0.6, 0.0, 0.8], (3, 1))
            speeds = np.array([0.5, 1.0, 2.0])
            batch.move_collider(range(3), name, targets, turned, speeds, 3.0)
            alone.move_collider(name, targets[1], turned[1], speeds[1], 3.0)
        for step in range(1, most + 1):
            batch.step(1)
            alone.step(1)
            if not np.array_equal(batch.positions()[1], alone.positions()):
                return step
    return None


def _measure(quick: bool) -> Iterator[Row]:
    for cloths, values, moves in (
            ('3 fabrics in air', _FABRIC, False),
            ('3 fabrics on bodies that move', _PUSHED, True)):
        unlike = _first_unlike_step(values, 50, moves=moves)
        yield {'cloths': cloths, 'steps': 50,
               'first step with other bits than alone': unlike or '-',
               FAULT: '' if unlike is None else 'other bits'}
    with closing(Context(single_thread=True)) as context:
        is_software = context.is_software
    sizes = ((12, 256), (32, 256)) if is_software else (
        (12, 256), (12, 4096), (32, 256), (32, 2048))
    for side, count in ((12, 8),) if quick else sizes:
        steps = 20 if quick or is_software else 500
        with Batch(_scenes(side, count)) as batch:
            batch.step(10)
            batch.finish()
            begin = time.perf_counter()
            batch.step(steps)
            batch.finish()
            seconds = time.perf_counter() - begin
            begin = time.perf_counter()
            for _ in range(10):
                batch.step(10)
                batch.positions()
            looks = time.perf_counter() - begin
            first = batch.positions()[0]
        with Simulation(_scenes(side, 1)[0]) as alone:
            alone.step(10 + steps + 100)
            same = np.array_equal(first, alone.positions())
        yield {'side': side, 'cloths': count,
               'G node steps/s': count * side**2 * steps / seconds / 1e9,
               'with positions read every 10 steps': count * side**2 * 100 / looks / 1e9,
               'bits of a cloth alone': same, FAULT: '' if same else 'other bits'}


SECTION = Section('batches', 'Batches', 40.0, _measure)
