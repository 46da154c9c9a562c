# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

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
