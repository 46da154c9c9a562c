# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The subject of a picture: a cloth at one time, running or as a snapshot, and colliders."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import instance
from cloth_sim_ros.sim.arguments import iterable
from cloth_sim_ros.sim.batch_cloth import ClothOfBatch
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Look
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import present_cells
from cloth_sim_ros.sim.snapshot import Snapshot
import numpy as np

# Thickness of a cloth whose scene is not known [m]: the default of contact.thickness.
_THICKNESS = 1e-3
# Cloths whose nodes are on the device, with a scene.
RUNNING = (Simulation, ClothOfBatch)


@dataclass(frozen=True)
class Subject:
    """
    A cloth at one time.

    :param cloth: has its positions
    :param shape: rows and columns
    :param cells: which there are, (rows - 1, cols - 1) bool; None for all
    :param cell: sides of a cell along a row and along a column [m]
    :param thickness: of the cloth [m]
    :param colliders: where they are at that time
    :param time: simulated [s]
    """

    cloth: Simulation | ClothOfBatch | Snapshot
    shape: tuple[int, int]
    cells: np.ndarray | None
    cell: tuple[float, float]
    thickness: float
    colliders: tuple[Collider, ...]
    time: float

    @classmethod
    def of(
            cls, cloth: Simulation | ClothOfBatch | Snapshot,
            colliders: Sequence[Collider] | None = None) -> Subject:
        """
        Return what there is to see of ``cloth``.

        :param colliders: None for those of a running cloth, and none beside a Snapshot
        :raises ClothSimError: when it is neither, or a chain, which has no surface
        """
        given = None if colliders is None else _checked(colliders)
        if isinstance(cloth, RUNNING):
            scene = cloth.scene
            _check_shape((scene.rows, scene.cols))
            return cls(
                cloth, (scene.rows, scene.cols), scene.cut_cells, scene.spacing,
                scene['contact.thickness'],
                cloth.colliders if given is None else given, cloth.time)
        if not isinstance(cloth, Snapshot):
            raise ClothSimError(
                f'a camera looks at a Simulation or a Snapshot, got {shown(cloth)}: give one, or '
                'Batch.cloth(number)')
        rows, cols = cloth.records.shape
        _check_shape((rows, cols))
        cells = present_cells(cloth.flags)
        along, down = (
            float(np.nanmean(np.linalg.norm(np.diff(cloth.positions, axis=axis), axis=-1)))
            for axis in (1, 0))
        return cls(
            cloth, (rows, cols), None if cells.all() else cells, (along, down), _THICKNESS,
            given or (), cloth.time)

    @property
    def look(self) -> Look:
        """Return how it looks: as its scene says, where that is known."""
        return self.cloth.scene.look if isinstance(self.cloth, RUNNING) else Look()

    def nodes(self) -> np.ndarray:
        """Return where its nodes are, (rows, cols, 3) float64 [m]; NaN where there is none."""
        cloth = self.cloth
        positions = cloth.positions() if isinstance(cloth, RUNNING) else cloth.positions
        return positions.astype(float)


def _checked(colliders: Sequence[Collider]) -> tuple[Collider, ...]:
    hint = 'give those of Simulation.colliders'
    return tuple(
        instance(each, Collider, 'a collider of a picture', hint)
        for each in iterable(colliders, 'the colliders of a picture', hint))


def _check_shape(shape: tuple[int, int]) -> None:
    if min(shape) < 2:
        raise ClothSimError(
            f'a camera sees surfaces, and a chain of {shape[0]} x {shape[1]} nodes has none: give '
            '2 or more rows and columns')
