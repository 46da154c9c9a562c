# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The longest stable time step of explicit springs, and how many substeps they need."""

from collections.abc import Callable
from decimal import Decimal
from decimal import ROUND_DOWN
from functools import lru_cache
import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cells import Cells
from cloth_sim_ros.sim.model.edge_kinds import EDGE_KINDS
from cloth_sim_ros.sim.model.edge_kinds import EdgeKind
from cloth_sim_ros.sim.model.scene_fields import MOST_SUBSTEPS
from cloth_sim_ros.sim.model.scene_fields import SCENE_FIELDS
from cloth_sim_ros.sim.scene import Scene
import numpy as np

# Substep that is chosen, over the limit of the flat cloth [1]: stretched cloths have a lower one
# (docs/explanation/numerics.md).
SAFETY = 0.85
# Wave numbers from 0 to pi along each axis that are tried [1]; an odd number includes pi / 2.
_SAMPLES = 129
_SHORTEST_DT = next(field.low for field in SCENE_FIELDS if field.name == 'dt') or 0.0
# Squarings of a matrix in power iteration [1], which leave an eigenvalue off by up to 1e-5, and
# the relative error of the limit by cells [1], which is rounded down by as much.
_SQUARINGS = 14
_EXACT = 1e-4
_Weigh = Callable[[EdgeKind, Scene], float]
_SHORT_KINDS = tuple(kind for kind in EDGE_KINDS if kind.family != 'bend')
_AUTOMATIC = 'auto_substeps: true'
_OTHER_SPRINGS = 'use softer springs, less damping or a larger node mass'


@lru_cache(maxsize=16)
def stability_limit(scene: Scene) -> float:
    """
    Return the longest stable substep [s] of the flat cloth at rest; infinite without springs.

    A plane wave with wave numbers (p, q) on the lattice feels the stiffness
    K(p, q) = sum over springs of 2 k n n^T (1 - cos(p dcol + q drow)), n the spring's
    direction, that of bending, and a damping C of the same form. One wave with eigenvalues kappa
    and gamma of these is stable while h^2 kappa + 2 h gamma < 4 m. The limit is the least such h
    over all waves. For a square lattice this is the closed form of docs/explanation/numerics.md.
    For a cloth of cells it is the bound by tiles of these.
    """
    if scene.cells is not None:
        return _limit_of_cells(scene, scene.cells, is_flat=True)
    return _least_limit(scene, *(_largest_eigenvalue(k) for k in _wave_matrices(scene)))


@lru_cache(maxsize=16)
def any_shape_limit(scene: Scene) -> float:
    """
    Return the longest substep [s] that is stable in any shape, folded or stretched.

    No spring is stiffer than k in any direction. So whatever the directions n, no eigenvalue
    is above that of the springs' graph: the trace of K, as n n^T has the trace 1.
    """
    if scene.cells is not None:
        return _limit_of_cells(scene, scene.cells, is_flat=False)
    return _least_limit(scene, *(k[0] + k[2] for k in _wave_matrices(scene)))


def safe_substep(scene: Scene) -> float:
    """Return the longest substep [s] that automatic substeps may take."""
    return min(SAFETY * stability_limit(scene), any_shape_limit(scene))


def choose_substeps(scene: Scene) -> int:
    """Return the number of substeps with auto_substeps: the fewest safe ones times refine."""
    return scene['refine'] * needed_substeps(scene['dt'], safe_substep(scene))


def needed_substeps(dt: float, longest: float) -> int:
    """Return the fewest substeps of ``dt`` [s] that are no longer than ``longest`` [s]."""
    return max(1, math.ceil(dt / longest - 1e-9))


def _least_limit(scene: Scene, kappa: np.ndarray, gamma: np.ndarray) -> float:
    """Return the limit [s] with bending, which is the same in all directions and shapes."""
    bending = _bending_of_waves(scene)
    kappa, gamma = kappa + bending, gamma + scene['bending.damping'] * bending
    present = (kappa > 0.0) | (gamma > 0.0)
    if not present.any():
        return math.inf
    kappa, gamma = kappa[present], gamma[present]
    # The root in the form that keeps its digits when gamma^2 is far above m kappa.
    root = np.sqrt(gamma**2 + 4.0 * scene.node_mass * kappa)
    return float(np.min(4.0 * scene.node_mass / (gamma + root)))


# A cloth of cells is the sum of tiles of some cells each, in stiffness and in mass. So no
# eigenvalue of the cloth is above the largest one of a tile (Fried 1972, DOI
# 10.1016/0020-7683(72)90042-9). Lines that span two cells are the sum of those along the sides of
# rows of cells: chains with half the mass at each end. Those of chords have eigenvalues up to 4 k,
# those of bending up to 16 c, as without ends.

# Cells along the side of a tile, at least [1]: with 3 the limit of the fabrics is 0.06 to 0.5 %
# below that of the endless lattice (docs/explanation/numerics.md, Cells), and takes some
# milliseconds to find. Cells with gaps have tiles of one cell.
_TILE = 3
_WEIGHTS: tuple[_Weigh, _Weigh] = (EdgeKind.stiffness, EdgeKind.damping)


def _tiles(cells: Cells) -> set[tuple[int, int]]:
    """Return the sizes of tiles that the cells can be divided into."""
    if not cells.present.all():
        return {(1, 1)}
    sides = []
    for count in cells.present.shape:
        parts = max(count // _TILE, 1)
        sides.append({count // parts, -(-count // parts)})
    return {(rows, cols) for rows in sides[0] for cols in sides[1]}


def _edges_of_tile(scene: Scene, tile: Cells, weigh: _Weigh, axes: np.ndarray) -> np.ndarray:
    """
    Return the matrix of the edges of a tile over the masses of its nodes, for a mass of 1.

    :param axes: along which an edge resists, by its direction, (directions, axes, axes)
    """
    rows, cols = tile.node_shares.shape
    count, size = rows * cols, axes.shape[-1]
    numbers = np.arange(count).reshape(rows, cols)
    matrix = np.zeros((count, count, size, size))
    for kind, block in zip(_SHORT_KINDS, axes):
        starts, ends = (numbers[each].ravel() for each in kind.everywhere(rows, cols))
        blocks = weigh(kind, scene) * tile.edge_shares(kind).ravel()[:, None, None] * block
        for one, other, sign in (
                (starts, starts, 1.0), (ends, ends, 1.0), (starts, ends, -1.0),
                (ends, starts, -1.0)):
            np.add.at(matrix, (one, other), sign * blocks)
    roots = np.repeat(tile.node_shares.ravel()**-0.5, size)
    flat = matrix.swapaxes(1, 2).reshape(count * size, count * size)
    return roots[:, None] * flat * roots


def _chords(scene: Scene, weigh: _Weigh) -> tuple[float, float]:
    """Return the largest eigenvalues of the edges along two cells, along rows and columns."""
    along_row, along_col = (
        4.0 * weigh(kind, scene) if span > 2 else 0.0
        for kind, span in zip(EDGE_KINDS[-2:], (scene.cols, scene.rows)))
    return along_row, along_col


def _in_plane(scene: Scene) -> np.ndarray:
    """Return n n^T of each kind of edge of the flat cloth."""
    dx, dy = scene.spacing
    directions = np.array([(kind.dcol * dx, kind.drow * dy) for kind in _SHORT_KINDS])
    n = directions / np.linalg.norm(directions, axis=1, keepdims=True)
    return n[:, :, None] * n[:, None, :]


def _limit_of_cells(scene: Scene, cells: Cells, *, is_flat: bool) -> float:
    """Return the limit [s] of the flat cloth, or of one in any shape."""
    axes = _in_plane(scene) if is_flat else np.ones((len(_SHORT_KINDS), 1, 1))
    return min(_limit_of_tile(scene, Cells(np.ones(size, dtype=bool)), axes)
               for size in _tiles(cells))


def _limit_of_tile(scene: Scene, tile: Cells, axes: np.ndarray) -> float:
    stiff, damped = (_edges_of_tile(scene, tile, weigh, axes) for weigh in _WEIGHTS)
    count, size = tile.node_shares.size, axes.shape[-1]
    bending = 16.0 * sum(scene.bending)
    for matrix, weigh, bent in zip(
            (stiff, damped), _WEIGHTS, (bending, scene['bending.damping'] * bending)):
        chords = _chords(scene, weigh)
        # In the plane, those along rows act along rows alone.
        matrix += np.diag(np.tile(
            np.array(chords if size == 2 else [sum(chords)]) + bent, count))
    if not (stiff.any() or damped.any()):
        return math.inf

    # The largest eigenvalue of h^2 K + 2 h C grows with h, and its slope too: Newton's method
    # comes to the limit from above.
    most = 4.0 * scene.node_mass
    h, step = math.inf, math.inf
    for matrix, power in ((stiff, 2), (2.0 * damped, 1)):
        if matrix.any():
            wave = _fastest_wave(matrix)
            h = min(h, float(most / (wave @ matrix @ wave))**(1.0 / power))
    while step > _EXACT * h:
        matrix = h * (h * stiff + 2.0 * damped)
        wave = _fastest_wave(matrix)
        step = float((wave @ matrix @ wave - most) / (2.0 * wave @ (h * stiff + damped) @ wave))
        h -= step
    return (1.0 - _EXACT) * h


def _fastest_wave(matrix: np.ndarray) -> np.ndarray:
    """
    Return the eigenvector of the largest eigenvalue of a symmetric, semidefinite ``matrix``.

    By power iteration with squares, of matrices so small that NumPy keeps them on one thread: on a
    busy machine the threads of ``eigh`` take 20 times as long.
    """
    power = matrix
    for _ in range(_SQUARINGS):
        power = power @ power
        power /= np.trace(power)
    wave = power[:, np.argmax(np.diag(power))]
    return np.asarray(wave / np.linalg.norm(wave))


def _waves(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return the wave numbers p along a row, (n, 1), and q along a column, (1, n)."""
    # A lattice one node wide carries no waves across.
    p = np.linspace(0.0, np.pi, _SAMPLES if scene.cols > 1 else 1)[:, None]
    q = np.linspace(0.0, np.pi, _SAMPLES if scene.rows > 1 else 1)[None, :]
    return p, q


def _bending_of_waves(scene: Scene) -> np.ndarray:
    """Return the stiffness of bending over the waves [N/m]: the square of that of edges."""
    return sum(c * (2.0 - 2.0 * np.cos(wave))**2 for c, wave in zip(scene.bending, _waves(scene)))


def _wave_matrices(scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Return K and C over the waves (p, q), each as its entries xx, xy, yy."""
    p, q = _waves(scene)
    dx, dy = scene.spacing
    totals = [np.zeros((3, p.size, q.size)) for _ in range(2)]
    for kind in EDGE_KINDS:
        if abs(kind.drow) >= scene.rows or abs(kind.dcol) >= scene.cols:
            continue
        direction = np.array([kind.dcol * dx, kind.drow * dy])
        nx, ny = direction / np.linalg.norm(direction)
        bend = 2.0 * (1.0 - np.cos(p * kind.dcol + q * kind.drow))
        outer = np.array([nx * nx, nx * ny, ny * ny])[:, None, None]
        totals[0] += kind.stiffness(scene) * outer * bend
        totals[1] += kind.damping(scene) * outer * bend
    return totals[0], totals[1]


def _largest_eigenvalue(matrix: np.ndarray) -> np.ndarray:
    xx, xy, yy = matrix
    return (xx + yy) / 2.0 + np.sqrt(((xx - yy) / 2.0)**2 + xy**2)


# How many substeps explicit springs need, and whether they are allowed.

def spring_substeps(scene: Scene, mode: str, *, check_stability: bool = True) -> int:
    """
    Return the substeps of dt that ``scene`` asks for, or those that are stable.

    :param mode: its name, for the message
    :raises ClothSimError: when they are too many, or too long to be stable
    """
    substeps = choose_substeps(scene) if scene['auto_substeps'] else scene['substeps']
    if substeps > MOST_SUBSTEPS:
        raise ClothSimError(_too_many(scene))
    if check_stability and scene['dt'] / substeps > stability_limit(scene):
        raise ClothSimError(_too_long(scene, substeps, mode))
    return substeps


# What is printed is rounded down, so that a dt computed from it is accepted, and every other
# number of a message is computed from those printed.

def _too_many(scene: Scene) -> str:
    dt, refine, safe = scene['dt'], scene['refine'], _rounded_down(safe_substep(scene))
    count = refine * needed_substeps(dt, float(safe))
    longest = safe * (MOST_SUBSTEPS // refine)
    refined = f', times refine {refine}' if refine > 1 else ''
    return (
        f'dt {dt:g} s would take {count:.3g} substeps of the {float(safe):g} s that are safe in '
        f'any shape{refined}, more than {MOST_SUBSTEPS}: {_way_out(longest, _OTHER_SPRINGS)}')


def _too_long(scene: Scene, substeps: int, mode: str) -> str:
    safe, limit = _rounded_down(safe_substep(scene)), _rounded_down(stability_limit(scene))
    other = _AUTOMATIC if choose_substeps(scene) <= MOST_SUBSTEPS else _OTHER_SPRINGS
    return (
        f'dt {scene["dt"]:g} s in {substeps} substeps is above the stability limit '
        f'{float(limit):g} s of a substep in mode {mode} (node mass {scene.node_mass:.3g} kg), '
        f'and {float(safe):g} s are safe in any shape: {_way_out(safe * substeps, other)}')


def _way_out(longest: Decimal, other: str) -> str:
    """Return that dt may be as long as ``longest`` [s], if a dt can be so short, or ``other``."""
    if longest >= _SHORTEST_DT:
        return f'set dt <= {float(_rounded_down(longest)):g}, or {other}'
    return f'set {other}' if other == _AUTOMATIC else other


def _rounded_down(value: float | Decimal) -> Decimal:
    """Return ``value`` in three digits, not above it."""
    exact = Decimal(value)
    return exact.quantize(Decimal(1).scaleb(exact.adjusted() - 2), ROUND_DOWN)
