# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far a run is from its reference, and how near its model came to one."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.results import Result
import numpy as np


@dataclass(frozen=True)
class Path:
    """
    What a run looked like.

    :param positions: at the times of the study, (times, rows, cols, 3) float64 [m]
    :param strains: largest of structural and shear springs, at every frame
    :param energies: kinetic, elastic and gravitational, (frames, 3) [J]
    """

    positions: np.ndarray
    strains: np.ndarray
    energies: np.ndarray

    def on_nodes_of(self, rows: int, cols: int) -> 'Path':
        """Return the path of the points where a cloth of ``rows`` x ``cols`` has its nodes."""
        along = _resampled(self.positions, rows, 1)
        return Path(_resampled(along, cols, 2), self.strains, self.energies)


def path_of(result: Result) -> Path:
    """Return the path that a run left in its arrays."""
    return Path(**{
        name: result.arrays[name].astype(float) for name in ('positions', 'strains', 'energies')})


def distances(path: Path, other: Path) -> np.ndarray:
    """Return the RMS distance of the same nodes at each time [m]."""
    squares = np.sum((path.positions - other.positions)**2, axis=-1)
    return np.sqrt(squares.mean(axis=(1, 2)))


def _resampled(values: np.ndarray, count: int, axis: int) -> np.ndarray:
    """Return ``values`` at ``count`` points evenly along ``axis``, linear between nodes."""
    present = values.shape[axis]
    if count == present:
        return values
    place = np.linspace(0.0, present - 1.0, count)
    first = np.minimum(place.astype(int), max(present - 2, 0))
    share = np.expand_dims(place - first, tuple(i for i in range(values.ndim) if i != axis))
    following = np.minimum(first + 1, present - 1)
    return (1.0 - share) * values.take(first, axis) + share * values.take(following, axis)


@dataclass(frozen=True)
class Reference:
    """
    The converged run of one model.

    :param path: where the cloth is
    :param changes: what the last refinement changed at each time, RMS over nodes [m]
    :param device: it was computed on
    :param run: key of the run it is; empty where it is extrapolated
    """

    path: Path
    changes: np.ndarray
    device: str
    run: str = ''

    def converged_times(self, allowed: float) -> int:
        """Return at how many of the times, from the first on, no more than ``allowed`` changed."""
        beyond = np.flatnonzero(~(self.changes <= allowed))
        return int(beyond[0]) if len(beyond) else len(self.changes)


def extrapolated(results: Sequence[Result], refine: Sequence[int]) -> Reference:
    """
    Return the reference by Richardson extrapolation of first order.

    With errors of first order in the substep, the last two runs give the limit of refinement. So
    do the two before them, and the difference is the change by the last refinement.

    :param results: coarse to fine, all done
    :param refine: how fine each is
    """
    paths = [path_of(result) for result in results]
    last, before = (
        _limit(paths[i - 1], paths[i], refine[i] / refine[i - 1]) for i in (-1, -2))
    return Reference(last, distances(last, before), results[-1].device)


def finest(results: Sequence[Result]) -> Reference:
    """Return the last of ``results`` as reference, and its distance from the one before."""
    paths = [path_of(result) for result in results]
    changes = distances(paths[-1], paths[-2]) if len(paths) > 1 else np.full(
        len(paths[-1].positions), np.inf)
    return Reference(paths[-1], changes, results[-1].device, results[-1].key)


def _limit(coarse: Path, fine: Path, ratio: float) -> Path:
    # The largest strain is not smooth in the substep: the finer one is taken as it is.
    positions, energies = (
        (ratio * getattr(fine, name) - getattr(coarse, name)) / (ratio - 1.0)
        for name in ('positions', 'energies'))
    return Path(positions, fine.strains, energies)


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
    scale = scene.mass * side * float(np.linalg.norm(scene['gravity']))
    if scale == 0.0:
        scale = float(reference.energies[:frames, 0].max(initial=0.0)) or 1.0
    return Errors(
        position=float(np.sqrt(np.mean(distances(path, reference)[:times]**2))) / side,
        strain=float(np.abs(path.strains - reference.strains)[:frames].max()),
        peak_strain=float(path.strains[:frames].max()),
        energy=float(np.abs(
            (path.energies - reference.energies).sum(axis=1))[:frames].max()) / scale)
