# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Pins: which nodes their names mean, and on which path a moving one is at each time."""

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass
import re
from typing import Any
from typing import Protocol

from cloth_sim_ros.files.errors import shown
from cloth_sim_ros.sim.arguments import integer
from cloth_sim_ros.sim.arguments import real_number
from cloth_sim_ros.sim.arguments import vector
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.errors import NotFoundError
import numpy as np

_REGIONS = {
    'none': None,
    'all': np.s_[:, :],
    'top_left': np.s_[0, 0],
    'top_right': np.s_[0, -1],
    'bottom_left': np.s_[-1, 0],
    'bottom_right': np.s_[-1, -1],
    'top_edge': np.s_[0, :],
    'bottom_edge': np.s_[-1, :],
}
# What a pin can be called.
PIN_NAMES = f'{", ".join(_REGIONS)}, or a node as "row,col"'
# Max. coordinate of a pin [m]: float32 rounds it by 6 cm, and farther out holds no cloth.
FARTHEST = 1e6
# Range of the speed of a pin [m/s], that of the parameter pin_speed.
_SLOWEST = 1e-6
_FASTEST = 1e6


def pinned_nodes(
        names: Sequence[str], rows: int, cols: int, parameter: str = 'pins',
        present: np.ndarray | None = None) -> np.ndarray:
    """
    Return which nodes ``names`` hold, (rows, cols) bool.

    :param names: corners, edges, all, none, or 'row,col'
    :param parameter: where the names stand, for the error
    :param present: which nodes there are, (rows, cols) bool; None for all
    :raises ClothSimError: for a name that is none of these or a node outside the cloth
    """
    pinned = np.zeros((rows, cols), dtype=bool)
    for name in names:
        node = re.fullmatch(r'\s*(\d{1,9})\s*,\s*(\d{1,9})\s*', name)
        if node:
            row, col = checked_node(int(node[1]), int(node[2]), rows, cols)
            _add(pinned, np.s_[row, col], name, parameter, present)
        elif name not in _REGIONS:
            raise ClothSimError(
                f'{parameter} has {shown(name)}: give {PIN_NAMES}')
        elif name != 'none':
            _add(pinned, _REGIONS[name], name, parameter, present)
    return pinned


def _add(
        pinned: np.ndarray, region: Any, name: str, parameter: str,
        present: np.ndarray | None) -> None:
    """Pin the nodes of ``region`` that there are; ClothSimError where there is none."""
    if present is not None and not np.any(present[region]):
        raise ClothSimError(
            f'{parameter} has {shown(name)}, where the shape of the cloth has no node: give a '
            'node of it, or a point by pin_points')
    pinned[region] = True if present is None else present[region]


def only_node(name: str, rows: int, cols: int, parameter: str) -> tuple[int, int]:
    """Return row and col of the node ``name``; ClothSimError when it is none or several."""
    nodes = np.argwhere(pinned_nodes([name], rows, cols, parameter)).tolist()
    if len(nodes) != 1:
        raise ClothSimError(
            f'{parameter} has {shown(name)}, which is {len(nodes)} nodes: '
            'give a corner, or a node as "row,col"')
    row, col = nodes[0]
    return row, col


def checked_node(
        row: int, col: int, rows: int, cols: int,
        present: np.ndarray | None = None) -> tuple[int, int]:
    """
    Return ``row`` and ``col`` as ints; ClothSimError when the cloth has no such node.

    :param present: which nodes there are, (rows, cols) bool; None for all
    """
    row = integer(row, 'the row of a node')
    col = integer(col, 'the col of a node')
    if not (0 <= row < rows and 0 <= col < cols):
        raise NotFoundError(
            f'there is no node ({shown(row)}, {shown(col)}) in a cloth of {rows} x {cols} nodes: '
            f'give a row from 0 to {rows - 1} and a col from 0 to {cols - 1}')
    if present is not None and not present[row, col]:
        raise NotFoundError(
            f'there is no node ({row}, {col}) in the shape of the cloth: give one of a cell that '
            'is there')
    return row, col


# Where a moving pin is at each time, and where it ends.


@dataclass(frozen=True)
class PinMove:
    """
    A straight path at constant speed, at the end of which the pin rests.

    :param row: of the pinned node
    :param col: of the pinned node
    :param target: x y z [m]
    :param speed: [m/s] in simulated time
    :param start: simulated time at which it begins [s]
    """

    row: int
    col: int
    target: tuple[float, float, float]
    speed: float
    start: float

    @classmethod
    def checked(
            cls, *, row: int, col: int, target: Sequence[float], speed: float,
            start: float) -> 'PinMove':
        """Return a PinMove, or raise ClothSimError saying which value is wrong."""
        x, y, z = vector(target, 'the target of a pin')
        if max(abs(x), abs(y), abs(z)) > FARTHEST:
            raise ClothSimError(
                f'the target of a pin must be at most {FARTHEST:g} m along each axis, got '
                f'{[x, y, z]}: keep the cloth near the origin')
        speed = real_number(speed, 'the speed of a pin', 'give it in simulated time [m/s]')
        if not _SLOWEST <= speed <= _FASTEST:
            raise ClothSimError(
                f'the speed of a pin must be from {_SLOWEST:g} to {_FASTEST:g} m/s, got {speed} '
                'm/s: give it in simulated time')
        return cls(row, col, (x, y, z), speed, float(start))

    @property
    def node(self) -> tuple[int, int]:
        """Return row and col."""
        return self.row, self.col


class Way(Protocol):
    """What a pin follows; ``begin`` and ``arrival`` are simulated times [s]."""

    begin: float
    arrival: float

    def position(self, time: float) -> np.ndarray:
        """Return where the pin is at ``time`` [s], (3,) [m]."""

    def velocity(self, begin: float, end: float, at_begin: np.ndarray) -> np.ndarray:
        """Return what takes the pin from ``at_begin`` at ``begin`` to its place at ``end``."""


def path_velocities(
        origins: np.ndarray, targets: np.ndarray,
        speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """
    Return the velocities [m/s] of straight ways, and how long each takes [s].

    :param origins: (..., 3) [m]
    :param targets: (..., 3) [m]
    :param speeds: (...) [m/s]
    """
    ways = targets - origins
    lengths = np.sqrt((ways * ways).sum(axis=-1))
    rates = np.divide(speeds, lengths, out=np.zeros_like(lengths), where=lengths > 0.0)
    return ways * rates[..., None], lengths / speeds


class PinPath:
    """
    The path of one pin, in float64, without accumulated error: it ends exactly at its target.

    ``begin`` and ``arrival`` are simulated times [s].

    :param move: the move to make
    :param origin: where the pin is when it begins [m], (3,)
    """

    def __init__(self, move: PinMove, origin: np.ndarray) -> None:
        """Plan the path from ``origin`` to the target."""
        self.move = move
        self._origin = np.asarray(origin, dtype=float)
        self._target = np.array(move.target)
        self._velocity, duration = path_velocities(
            self._origin, self._target, np.array(move.speed))
        self.begin = move.start
        self.arrival = move.start + float(duration)

    def put_off(self, now: float, until: float) -> 'PinPath':
        """Return the rest of the way, on which the pin stands still from ``now`` ``until`` [s]."""
        later = copy(self)
        later._origin = self.position(now)
        later.begin = until
        later.arrival += until - now
        return later

    def position(self, time: float) -> np.ndarray:
        """Return where the pin is at ``time`` [s], (3,) [m]."""
        if time >= self.arrival:
            return self._target
        return self._origin + self._velocity * max(time - self.begin, 0.0)

    def velocity(self, begin: float, end: float, at_begin: np.ndarray) -> np.ndarray:
        """
        Return what takes the pin from where it is at ``begin`` to where it is at ``end`` [m/s].

        :param at_begin: where it is at ``begin`` [m]; on another way, if this one begins later
        """
        # On the way the velocity has the same bits in each step: only then has nothing changed.
        if self.begin <= begin and end <= self.arrival:
            return self._velocity
        return (self.position(end) - at_begin) / (end - begin)
