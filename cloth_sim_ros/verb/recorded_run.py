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

"""Simulate a scene into a recording with a name, and tell why it stopped early."""

from pathlib import Path
from typing import Any

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.verb.batch_run import BatchRun


def record_run(
        scene: Scene, node_values: dict[str, Any], seconds: float, directory: str | Path,
        name: str, *, check_stability: bool = True, setting: str = '--out') -> str:
    """
    Simulate ``seconds`` into ``directory``/``name``; return why either stopped early, or ''.

    :param check_stability: False lets dt pass the stability limit
    :param setting: what ``directory`` was given by, for errors
    :raises ClothSimError: when the scene can't be run, or the recording is there already
    """
    simulation = Simulation(scene, check_stability=check_stability)
    try:
        run = BatchRun(
            simulation, {**node_values, 'recording.name': name}, str(directory), setting=setting)
        run.advance(seconds)
        return run.problem or run.recording_problem
    finally:
        simulation.close()
