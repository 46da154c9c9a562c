# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a run is from its reference."""

from dataclasses import dataclass

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.trade.path import distances
from cloth_sim_ros.study.trade.path import Path
import numpy as np


@dataclass(frozen=True)
class Errors:
    """
    Differences from a reference over the times that count.

    :param position: RMS over times and nodes, over the longer side of the cloth
    :param strain: largest difference of the largest strain, over the frames
    :param peak_strain: of the run itself
    :param energy: largest difference of the total energy, over M g L of the cloth, or over the
        peak kinetic energy where there is no gravity
    """

    position: float
    strain: float
    peak_strain: float
    energy: float


def errors(path: Path, reference: Path, scene: Scene, times: int, frames: int) -> Errors:
    """
    Return the errors of ``path``, which has the nodes of ``reference``.

    :param times: how many of them count, from the first on
    :param frames: how many of them count
    """
    side = max(scene['width'], scene['height'])
    scale = scene.node_mass * scene.node_count * side * float(np.linalg.norm(scene['gravity']))
    if scale == 0.0:
        scale = float(reference.energies[:frames, 0].max(initial=0.0)) or 1.0
    return Errors(
        position=float(np.sqrt(np.mean(distances(path, reference)[:times]**2))) / side,
        strain=float(np.abs(path.strains - reference.strains)[:frames].max()),
        peak_strain=float(path.strains[:frames].max()),
        energy=float(np.abs(
            (path.energies - reference.energies).sum(axis=1))[:frames].max()) / scale)
