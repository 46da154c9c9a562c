# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""One pass of the implicit step against dense algebra, in both forms of its system."""

from collections.abc import Iterator

from cloth_sim_ros.reference.implicit_cloth import ImplicitCloth
from cloth_sim_ros.reference.implicit_step import Passes
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

SCENE = {'rows': 5, 'cols': 6, 'width': 1.3, 'height': 0.9, 'dt': 0.01, 'auto_substeps': False,
         'pins': ['top_left', 'top_right', '2,3'], 'damping.shear': 0.02,
         'stiffness.bend': 7.0}
KINDS = {
    'springs': ((), ('structural', 'shear', 'bend')),
    'hard and springs': (('structural',), ('shear', 'bend')),
    'all hard': (('structural', 'shear', 'bend'), ()),
    'without bend': (('structural', 'shear'), ())}
RESTS = {(0, 1): 'structural', (1, 0): 'structural', (1, 1): 'shear', (1, -1): 'shear',
         (0, 2): 'bend', (2, 0): 'bend'}


def _random_cloth(kind: str, passes: Passes) -> ImplicitCloth:
    """Return a cloth with random places and velocities, and a pin that moves."""
    hard, springs = KINDS[kind]
    random = np.random.default_rng(3)
    cloth = ImplicitCloth(
        Scene({**SCENE, 'constraint.hard': hard, 'constraint.springs': springs}), passes=passes)
    cloth.positions += random.normal(0.0, 0.02, cloth.positions.shape)
    cloth.velocities += random.normal(0.0, 0.5, cloth.positions.shape) * cloth.free[..., None]
    cloth.move_pin(0, 0, np.array([0.3, -0.1, 0.2]))
    return cloth


def _edges(cloth: ImplicitCloth) -> Iterator[tuple[str, tuple[int, int], tuple[int, int]]]:
    """Yield the family of each edge and its two nodes, in the order of the reference."""
    scene = cloth.scene
    for (down, right), family in RESTS.items():
        if family not in (*scene['constraint.hard'], *scene['constraint.springs']):
            continue
        for row, col in np.ndindex(scene.rows, scene.cols):
            if row + down < scene.rows and 0 <= col + right < scene.cols:
                yield family, (row, col), (row + down, col + right)


def _rows(cloth: ImplicitCloth) -> tuple[np.ndarray, ...]:
    """
    Return what each edge with a free end has, counted edge by edge from the scene alone.

    :return: its place among all edges; its row of J; its slope h k' + k_d [N s/m], with 1 / E for
        k' where it is hard; its tension where v leads; and beta h^2 lambda+ / l [kg]
    """
    scene, h, beta = cloth.scene, cloth.dt, cloth._make.passes.beta
    velocities = cloth.velocities.copy()
    velocities[0, 0] = [0.3, -0.1, 0.2]
    weight = 30 * scene.node_mass * 9.81
    places, rows, slopes, tensions, across = [], [], [], [], []
    for place, (family, one, other) in enumerate(_edges(cloth)):
        if not (cloth.free[one] or cloth.free[other]):
            continue
        rest = np.hypot(
            *((b - a) * step for a, b, step in zip(one, other, scene.spacing[::-1])))
        d, u = (field[one] - field[other] for field in (cloth.positions, velocities))
        length = np.sqrt(d @ d)
        n = d / length
        row = np.zeros((*cloth.free.shape, 3))
        row[one], row[other] = n, -n
        hard = family in scene['constraint.hard']
        # 0.03 x 5 lines is less than 1.
        k = weight / (0.008 * 0.15) / rest if hard else scene.stiffness(family)
        damping = 0.0 if hard else scene.damping(family)
        turned = h * (u - (u @ n) * n)
        longer = (np.sqrt(length**2 + turned @ turned) - length) * (
            cloth._make.passes.foresees_turn)
        places.append(place)
        rows.append(row.ravel())
        slopes.append(h * k + damping)
        tensions.append(k * (length + longer + h * (u @ n) - rest) + damping * (u @ n))
        # In the first step of a cloth, of the tensions that its lengths have.
        across.append(beta * h**2 * max(k * (length - rest), 0.0) / length)
    return tuple(np.array(each) for each in (places, rows, slopes, tensions, across))


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('passes', [
    Passes(end=0, foresees_turn=False, beta=0.0), Passes(end=0)], ids=['plain', 'with K_geo'])
def test_a_pass_solves_the_printed_system(kind, passes):
    """A pass is not (M + beta h^2 K_geo + J^T h (h k + k_d) J) dv = h F - h J^T lambda(v)."""
    cloth = _random_cloth(kind, passes)
    places, rows, slopes, tensions, across = _rows(cloth)
    h, mass = cloth.dt, cloth.scene.node_mass
    matrix = mass * np.eye(rows.shape[1]) + rows.T @ ((h * slopes)[:, None] * rows)
    for row, geometric in zip(rows, across):
        # The part of K_geo by this edge: (I - n n^T) between its ends.
        ends = [slice(3 * node, 3 * node + 3) for node in np.flatnonzero(
            row.reshape(-1, 3).any(axis=1))]
        n = row[ends[0]]
        block = geometric * (np.eye(3) - np.outer(n, n))
        for first in ends:
            for second in ends:
                matrix[first, second] += block if first == second else -block
    free = np.repeat(cloth.free.ravel(), 3)
    right = np.tile(h * mass * np.array(cloth.scene['gravity']), cloth.scene.node_count)
    right -= h * rows.T @ tensions
    change = np.zeros(len(free))
    change[free] = np.linalg.solve(matrix[np.ix_(free, free)], right[free])
    velocities = cloth.velocities.copy()
    velocities[0, 0] = [0.3, -0.1, 0.2]
    expected = velocities + change.reshape(velocities.shape)
    start = cloth.positions.copy()
    cloth.step()
    np.testing.assert_allclose(cloth.velocities, expected, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(cloth.positions, start + h * expected, atol=1e-10)
    np.testing.assert_allclose(
        cloth.tension[places], tensions + slopes * (rows @ change),
        atol=1e-9 * np.abs(cloth.tension).max())


@pytest.mark.parametrize('kind', KINDS)
def test_the_dual_form_has_the_same_tensions(kind):
    """
    The tensions of a pass are not those of (J W J^T + E) lambda = r, the system of the paper.

    One row for each edge, W the inverse masses: with v+ = v + h W (F - J^T lambda) and
    lambda = lambda(v) + (h k + k_d) J (v+ - v), E = 1 / (h (h k + k_d)) and
    r = h E lambda(v) / h + J W F.
    """
    cloth = _random_cloth(kind, Passes(end=0, beta=0.0))
    places, rows, slopes, tensions, _ = _rows(cloth)
    inverse = np.repeat(cloth.free.ravel(), 3) / cloth.scene.node_mass
    compliance = 1.0 / (cloth.dt * slopes)
    force = np.tile(
        cloth.scene.node_mass * np.array(cloth.scene['gravity']), cloth.scene.node_count)
    found = np.linalg.solve(
        rows * inverse @ rows.T + np.diag(compliance),
        compliance * tensions + rows @ (inverse * force))
    cloth.step()
    np.testing.assert_allclose(
        cloth.tension[places], found, atol=1e-9 * np.abs(found).max())
