# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
The table of edges: which two nodes each joins, of which family and rest length.

Shaders get it by ``edge_defines``: nothing else says what edges there are.
"""

from collections.abc import Collection
from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

from cloth_sim_ros.sim.model.materials import WARP
from cloth_sim_ros.sim.model.materials import WEFT
from cloth_sim_ros.sim.model.scene_fields import FAMILIES
import numpy as np

# Row and column of some nodes, as slices or as arrays of integers: what NumPy indexes by.
Index = tuple[slice, slice] | tuple[np.ndarray, np.ndarray]


class Springs(Protocol):
    """What edges ask of a scene."""

    @property
    def spacing(self) -> tuple[float, float]:
        """Rest distance of neighbours along a row and along a column [m]."""

    def stiffness(self, family: str, direction: int | None = None) -> float:
        """Return the stiffness of the springs of a family [N/m]."""

    def damping(self, family: str, direction: int | None = None) -> float:
        """Return the damping of the springs of a family [N s/m]."""


@dataclass(frozen=True)
class EdgeKind:
    """
    The edges from each node (row, col) to the node (row + drow, col + dcol).

    :param number: place in the last axis of arrays that have a number for every edge; the first
        two axes are the row and column of the node it starts at
    :param family: structural, shear or bend
    :param rest: place in arrays that have a number for every rest length
    """

    number: int
    name: str
    family: str
    drow: int
    dcol: int
    rest: int

    def rest_length(self, scene: Springs) -> float:
        """Return the length at rest [m]."""
        dx, dy = scene.spacing
        return float(np.hypot(self.dcol * dx, self.drow * dy))

    @property
    def direction(self) -> int:
        """Return which of two values, of warp and weft, is that of these edges."""
        return WEFT if self.dcol == 0 else WARP

    def stiffness(self, scene: Springs) -> float:
        """Return that of the springs of ``scene`` [N/m]."""
        return scene.stiffness(self.family, self.direction)

    def damping(self, scene: Springs) -> float:
        """Return that of the springs of ``scene`` [N s/m]."""
        return scene.damping(self.family, self.direction)

    def everywhere(self, rows: int, cols: int) -> tuple[Index, Index]:
        """Return the starts and the ends of all edges of a cloth."""
        height, width = max(rows - self.drow, 0), max(cols - abs(self.dcol), 0)
        left = max(-self.dcol, 0)
        return (
            np.s_[:height, left:left + width],
            np.s_[self.drow:self.drow + height, left + self.dcol:left + self.dcol + width])

    def starting_at(self, nodes: np.ndarray, rows: int, cols: int) -> np.ndarray:
        """Return which ``nodes`` (n, 2) are the start of an edge of the cloth."""
        starts_inside = _are_inside(nodes, rows, cols)
        return starts_inside & _are_inside(nodes + (self.drow, self.dcol), rows, cols)


def _are_inside(nodes: np.ndarray, rows: int, cols: int) -> np.ndarray:
    return np.all((nodes >= 0) & (nodes < (rows, cols)), axis=1)


EDGE_KINDS = (
    EdgeKind(0, 'row', 'structural', 0, 1, rest=0),
    EdgeKind(1, 'column', 'structural', 1, 0, rest=1),
    EdgeKind(2, 'diagonal', 'shear', 1, 1, rest=2),
    EdgeKind(3, 'crossing', 'shear', 1, -1, rest=2),
    EdgeKind(4, 'two_row', 'bend', 0, 2, rest=3),
    EdgeKind(5, 'two_column', 'bend', 2, 0, rest=4),
)


@dataclass(frozen=True)
class EdgesAt:
    """
    The edges with an end in some nodes, each once for each of these ends, kind by kind.

    :param nodes: that end, as places in the list of nodes, (edges,)
    :param kinds: numbers of the kinds, (edges,)
    :param starts: rows and columns of the node each edge starts at, (2, edges)
    :param ends: of the node it ends at, (2, edges)
    :param others: of the end that is not the one in ``nodes``, (2, edges)
    """

    nodes: np.ndarray
    kinds: np.ndarray
    starts: np.ndarray
    ends: np.ndarray
    others: np.ndarray


def edges_at(nodes: np.ndarray, rows: int, cols: int) -> EdgesAt:
    """Return the edges with an end in ``nodes``, (n, 2) int, of a cloth; pins change rarely."""
    return _edges_at(np.asarray(nodes, dtype=np.int64).tobytes(), rows, cols)


# Max. cached results [1]: pins and a grasp or two for each cloth of a process.
@lru_cache(maxsize=16)
def _edges_at(nodes: bytes, rows: int, cols: int) -> EdgesAt:
    given = np.frombuffer(nodes, dtype=np.int64).reshape(-1, 2)
    parts = []
    for kind in EDGE_KINDS:
        offset = np.array((kind.drow, kind.dcol))
        for starts, others in ((given, given + offset), (given - offset, given - offset)):
            there = np.flatnonzero(kind.starting_at(starts, rows, cols))
            parts.append((
                there, np.full(len(there), kind.number), starts[there].T,
                (starts[there] + offset).T, others[there].T))
    return EdgesAt(*(np.concatenate(part, axis=-1) for part in zip(*parts)))


# An edge of each rest length, in their order.
REST_KINDS = tuple({kind.rest: kind for kind in reversed(EDGE_KINDS)}[rest] for rest in range(5))
# The walk over all edges, as shaders have it.
EACH_EDGE = 'EACH_EDGE(DO, WITH)'


def rest_lengths(scene: Springs) -> tuple[float, ...]:
    """Return the rest lengths [m] along a row, a column, the diagonal, and two along each."""
    return tuple(kind.rest_length(scene) for kind in REST_KINDS)


def edge_defines(families: Collection[str]) -> dict[str, object]:
    """
    Return the table for shaders of a cloth that has edges of ``families``.

    HAS_<FAMILY> is 1 where there are any. EACH_EDGE(DO, WITH) is DO(WITH, edge, drow, dcol,
    family, rest) for each kind of them, EACH_SHORT_EDGE for each kind that joins neighbours,
    whatever the families; SHORT_EDGES are those as vectors (drow, dcol). EDGE_<NAME>,
    REST_<NAME> and <FAMILY> are numbers.
    """
    kinds = [kind for kind in EDGE_KINDS if kind.family in families]
    short = [kind for kind in EDGE_KINDS if kind.family != 'bend']
    return {
        **{f'HAS_{family.upper()}': int(family in families) for family in FAMILIES},
        **{family.upper(): number for number, family in enumerate(FAMILIES)},
        **{f'EDGE_{kind.name.upper()}': kind.number for kind in EDGE_KINDS},
        **{f'REST_{kind.name.upper()}': kind.rest for kind in REST_KINDS},
        EACH_EDGE: _walk(kinds),
        'EACH_SHORT_EDGE(DO, WITH)': _walk(short),
        'SHORT_EDGES': ', '.join(f'ivec2({kind.drow}, {kind.dcol})' for kind in short),
    }


def _walk(kinds: Collection[EdgeKind]) -> str:
    return ' '.join(
        f'DO(WITH, {kind.number}, {kind.drow}, {kind.dcol}, {kind.family.upper()}, {kind.rest})'
        for kind in kinds)
