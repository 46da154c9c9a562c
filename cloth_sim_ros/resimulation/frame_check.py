# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Whether the frames of two runs are the same, and by how much they are not."""

from dataclasses import dataclass

from cloth_sim_ros.sim.snapshot import POINT_DTYPE
import numpy as np

_FIELDS = POINT_DTYPE.names or ()


@dataclass(frozen=True)
class Difference:
    """
    The largest difference between two frames.

    :param frame: its number, from 1
    :param time: of the recorded frame [s], continuing across resets
    :param node: row and col
    :param distance: of the two positions of that node [m]; 0 when only other fields differ
    :param fields: those whose bits differ anywhere in the frame
    """

    frame: int
    time: float
    node: tuple[int, int]
    distance: float
    fields: tuple[str, ...]


@dataclass
class FrameCheck:
    """
    Compare frame by frame.

    :param frames: compared so far
    :param equal: of these, bitwise identical in all fields
    :param first: the first that was not equal
    :param largest: the one with the largest distance of a node
    :param last_rms: RMS distance of the nodes in the last frame [m]
    :param missing_fields: of a point, those that the recording lacks
    :param other_grids: frames that have other rows and cols, and were not compared
    """

    frames: int = 0
    equal: int = 0
    first: Difference | None = None
    largest: Difference | None = None
    last_rms: float = 0.0
    missing_fields: tuple[str, ...] = ()
    other_grids: int = 0

    def compare(
            self, time: float, recorded: np.ndarray, made: np.ndarray,
            unknown_flags: int = 0) -> None:
        """
        Compare a frame.

        :param time: of the recorded frame [s]
        :param recorded: (rows, cols) records with fields of POINT_DTYPE
        :param made: the same of this run, of POINT_DTYPE
        :param unknown_flags: those that this run can't know yet, and are not compared
        """
        self.frames += 1
        if unknown_flags and 'flags' in (recorded.dtype.names or ()):
            recorded, made = _without(recorded, unknown_flags), _without(made, unknown_flags)
        names = tuple(name for name in _FIELDS if name in (recorded.dtype.names or ()))
        self.missing_fields = tuple(name for name in _FIELDS if name not in names)
        unequal = {name: _bits(recorded, name) != _bits(made, name) for name in names}
        fields = tuple(name for name in names if unequal[name].any())
        if not fields:
            self.equal += 1
            self.last_rms = 0.0
            return
        away = np.stack([
            recorded[axis].astype(float) - made[axis].astype(float) for axis in 'xyz'])
        # Where there is no node, both are NaN.
        is_moved = np.any([unequal[axis] for axis in 'xyz'], axis=0)
        distances = np.where(is_moved, np.sqrt((away**2).sum(axis=0)), 0.0)
        there = is_moved | ~np.isnan(recorded['x'])
        self.last_rms = float(np.sqrt((distances[there]**2).mean()))
        # Where all positions are equal, a node whose other fields are not is of interest.
        where = distances if distances.any() else np.any(list(unequal.values()), axis=0)
        row, col = np.unravel_index(int(np.argmax(where)), where.shape)
        difference = Difference(
            self.frames, time, (int(row), int(col)), float(distances[row, col]), fields)
        if self.first is None:
            self.first = difference
        if self.largest is None or difference.distance > self.largest.distance:
            self.largest = difference


def _without(records: np.ndarray, flags: int) -> np.ndarray:
    left = records.copy()
    left['flags'] &= np.uint32(~flags & 0xffffffff)
    return left


def _bits(records: np.ndarray, name: str) -> np.ndarray:
    kind = POINT_DTYPE[name]
    return np.ascontiguousarray(records[name]).astype(kind, copy=False).view(np.uint32)
