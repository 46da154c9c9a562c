# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Functions that runs of the tests name: a worker imports them from here."""

import os
from pathlib import Path
import signal
import time
from typing import Any

import cloth_sim_ros
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np


def square(scene: dict[str, Any], *, number: float, folder: str = '') -> dict[str, Any]:
    """Return the square, and write a file in ``folder`` that records the call."""
    if folder:
        Path(folder, f'{number}-{os.getpid()}-{time.monotonic_ns()}').touch()
    return {'square': number**2, 'device': 'none', 'process': os.getpid(),
            'threads': os.environ.get('LP_NUM_THREADS', '')}


def drop(scene: dict[str, Any], *, seconds: float) -> dict[str, Any]:
    """Simulate ``seconds`` and return the positions."""
    simulation = Simulation(Scene(scene))
    simulation.advance(seconds)
    snapshot = simulation.snapshot()
    result = {'device': simulation.device, 'max_strain': snapshot.max_strain,
              'positions': np.array(snapshot.positions)}
    simulation.close()
    return result


def fail(scene: dict[str, Any]) -> dict[str, Any]:
    """Raise what no run expects."""
    raise ZeroDivisionError('as asked')


def die(scene: dict[str, Any]) -> dict[str, Any]:
    """End the process, as the system does when memory is short."""
    os.kill(os.getpid(), signal.SIGKILL)


def meet(scene: dict[str, Any], *, folder: str, name: str, others: int) -> dict[str, Any]:
    """Wait until ``others`` runs have come to ``folder``, too."""
    Path(folder, name).touch()
    deadline = time.monotonic() + 300.0
    while len(list(Path(folder).iterdir())) <= others:
        if time.monotonic() > deadline:
            raise TimeoutError('nobody came')
        time.sleep(0.01)
    return {'device': 'none', 'threads': os.environ.get('LP_NUM_THREADS', '')}


def sleep(scene: dict[str, Any], *, seconds: float) -> dict[str, Any]:
    """Take ``seconds``."""
    time.sleep(seconds)
    return {'device': 'none'}


def edit(scene: dict[str, Any]) -> dict[str, Any]:
    """Change the code of this package, as somebody does who works on it meanwhile."""
    with open(cloth_sim_ros.__file__, 'a') as file:
        file.write('# changed\n')
    return {'device': 'none'}
