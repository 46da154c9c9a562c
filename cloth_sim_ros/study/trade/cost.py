# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How long settings take by the clock, measured in turn with nothing beside them."""

from collections.abc import Mapping
from collections.abc import Sequence
import time
from typing import Any

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.simulation import SINGLE_THREAD_NODES


def cost(
        scene: dict[str, Any], *, settings: Sequence[Mapping[str, Any]], seconds: float,
        frame: float, rounds: int) -> dict[str, Any]:
    """
    Return the wall time of each setting in each round, in a simulated second.

    :param settings: scene parameters of each; in a round each has its turn, from the start
    :param seconds: simulated in a turn
    :param frame: simulated in one call, after which the device is waited for [s]
    """
    context = Context(single_thread=Scene(scene).node_count < SINGLE_THREAD_NODES)
    runs = [Simulation(Scene({**scene, **values}), context=context) for values in settings]
    for run in runs:
        # The first steps compile what the device puts off until then.
        _wall_seconds(run, frame, 1)
    wall = [
        [_wall_seconds(run, frame, round(seconds / frame)) / seconds for run in runs]
        for _ in range(rounds)]
    result = {'device': context.device, 'wall_seconds': [list(own) for own in zip(*wall)]}
    for run in runs:
        run.close()
    context.close()
    return result


def _wall_seconds(run: Simulation, frame: float, frames: int) -> float:
    run.reset()
    run.finish()
    begin = time.perf_counter()
    for _ in range(frames):
        run.advance(frame)
        run.finish()
    return time.perf_counter() - begin
