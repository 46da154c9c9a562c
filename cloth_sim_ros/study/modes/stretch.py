# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""How far the edges of a cloth stretch in a run."""

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.reference.edges import spring_sets
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.study.modes.contenders import StretchBound
import numpy as np

# Of the edges that are measured. Bend springs may stretch: they only stand for bending.
STRETCHED_FAMILIES = ('structural', 'shear')
_PERCENTILE = 95.0


@dataclass(frozen=True)
class Stretch:
    """
    The stretch of structural and shear edges; see ``edge_stretch``.

    :param peak: largest of all edges and frames
    :param worst_frame_percentile: 95th percentile over the edges of a frame, in the frame where
        that is largest
    :param percentile: 95th percentile over the edges of all frames together
    """

    peak: float
    worst_frame_percentile: float
    percentile: float

    def is_within(self, bound: StretchBound) -> bool:
        """Return whether it keeps to ``bound``."""
        return self.peak <= bound.peak and self.worst_frame_percentile <= bound.percentile


def edge_stretch(scene: Scene, positions: np.ndarray) -> np.ndarray:
    """
    Return max(l / L0 - 1, 0) of every structural and shear edge, whether it is a spring or not.

    :param positions: (rows, cols, 3) [m]
    :return: (edges,) float64; an edge that is shorter than at rest counts as 0
    """
    positions = positions.astype(float)
    return np.concatenate([
        np.maximum(edges.strains(positions), 0.0).ravel()
        for edges in spring_sets(scene, STRETCHED_FAMILIES)
        if edges.family in STRETCHED_FAMILIES])


def stretch_of(frames: Sequence[np.ndarray]) -> Stretch:
    """
    Return the stretch of a run.

    :param frames: of ``edge_stretch``, (edges,) each; at least one
    """
    return Stretch(
        peak=float(max(frame.max() for frame in frames)),
        worst_frame_percentile=float(max(np.percentile(frame, _PERCENTILE) for frame in frames)),
        percentile=float(np.percentile(np.concatenate(frames), _PERCENTILE)))
