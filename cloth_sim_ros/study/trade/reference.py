# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What finer and finer settings of a model come to, and how near to it they came."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.study.results import Result
from cloth_sim_ros.study.trade.path import distances
from cloth_sim_ros.study.trade.path import Path
from cloth_sim_ros.study.trade.path import path_of
import numpy as np


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
    Return the reference that runs of first order point to.

    With errors of first order in the substep, the last two runs tell where an endless refinement
    leads; the two before them do, too, and the difference is what the last step changed.

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
