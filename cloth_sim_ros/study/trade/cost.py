# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
