# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The solver's matrix and right side are those of the law of the edges, added up in float64."""

from dataclasses import replace

from cloth_sim_ros.sim.solver.edge_law import BETA
import numpy as np
import pytest

SHAPES = [(1, 2), (1, 9), (9, 1), (2, 2), (2, 30), (30, 2), (5, 7), (13, 16), (17, 12)]
PINS = [['none'], ['top_left', 'top_right'], ['top_edge', '4,3'], ['all']]
LAYOUTS = [
    {'loads': 'texture', 'block': 1},
    pytest.param({'loads': 'texture', 'block': 3}, marks=pytest.mark.long),
    {'loads': 'storage', 'block': 1}, {'loads': 'storage', 'block': 4}]


def assert_right_side(case):
    """Compare b of the device with that of the float64 system."""
    right = case.solver.right_side()
    # What is missing in a further solve can be as small as what tensions are rounded by.
    assert np.linalg.norm(right - case.system.right_side) <= 2.0 * case.system.rounding()
    assert np.all(right[~case.free[..., 0]] == 0.0)


def assert_matrix(case):
    """Compare the matrix of the device with that of the float64 system."""
    vector = case.random_vector(1)
    expected = case.free * case.system.times(vector)
    off = np.linalg.norm(case.solver.multiply(vector) - expected)
    assert off <= 1e-6 * np.linalg.norm(expected)


@pytest.mark.parametrize('shape', SHAPES)
def test_matrix_in_any_shape(make_case, shape, kind, geometric):
    """An edge would be missing, counted twice, or of the wrong weight or direction."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'width': 0.7}, kind=kind, geometric=geometric)
    assert_matrix(case)


@pytest.mark.parametrize('pins', PINS, ids=lambda pins: pins[0])
def test_matrix_with_any_pins(make_case, pins, kind, geometric):
    """An edge to a pinned node would weigh the wrong amount, or a pinned node would move."""
    case = make_case({'rows': 7, 'cols': 9, 'pins': pins}, kind=kind, geometric=geometric)
    assert_matrix(case)
    product = case.solver.multiply(case.random_vector(1))
    assert np.all(product[~case.free[..., 0]] == 0.0)


@pytest.mark.parametrize('choice', LAYOUTS)
def test_matrix_in_every_layout(make_case, choice, kind, geometric):
    """A device that suits another layout would solve another system."""
    case = make_case({'rows': 13, 'cols': 9, **choice}, kind=kind, geometric=geometric)
    assert_matrix(case)
    case.prepare()
    assert_right_side(case)


def test_matrix_is_symmetric_and_positive(make_case, kind, geometric):
    """Conjugate gradients would not converge."""
    case = make_case({'rows': 13, 'cols': 10}, kind=kind, geometric=geometric)
    u, w = case.random_vector(1), case.random_vector(2)
    au, aw = case.solver.multiply(u).astype(float), case.solver.multiply(w).astype(float)
    assert abs(np.sum(w * au) - np.sum(u * aw)) < 1e-6 * np.linalg.norm(au) * np.linalg.norm(w)
    # The mass alone gives u.u; the edges can only add to it.
    assert np.sum(u * au) > np.sum(u.astype(float)**2)


def test_geometric_mass_resists_across_edges_that_pull(make_case):
    """Waves across tight edges would grow, or slack edges would be pushed aside."""
    plain = make_case({'rows': 6, 'cols': 7}, kind='hard')
    case = make_case({'rows': 6, 'cols': 7}, kind='hard', geometric=BETA)
    tensions = case.solver.tensions()
    assert (tensions > 0.0).any() and (tensions < 0.0).any()
    vector = case.random_vector(1)
    added = np.sum(vector * (case.system.times(vector) - plain.system.times(vector)))
    assert added > 0.0
    measured = np.sum(vector * (
        case.solver.multiply(vector).astype(float) - plain.solver.multiply(vector)))
    # Both products are rounded, to 1e-6 of what the edges along their direction have in them.
    assert measured == pytest.approx(added, abs=2e-6 * np.linalg.norm(vector) * np.linalg.norm(
        case.system.times(vector)))


@pytest.mark.parametrize('shape', [(1, 9), (2, 2), (30, 2), (13, 16)])
@pytest.mark.parametrize('foresees_turn', [False, True])
@pytest.mark.parametrize('kick', [None, 0.017])
def test_right_side(make_case, shape, kind, foresees_turn, kick):
    """The step would pull the wrong way, forget gravity or damping, or move a pinned node."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'height': 1.3}, kind=kind, foresees_turn=foresees_turn,
        kick=kick)
    assert_right_side(case)


@pytest.mark.parametrize('kind', ['springs', 'limited'])
def test_no_limit_force_when_a_spring_inverts(make_case, kind):
    """Two nodes that pass through each other would be repelled by a limit that is not set."""
    positions = np.array([[(0.0, 0.0, 1.0), (0.1, 0.0, 1.0), (0.2, 0.0, 1.0)]])
    velocities = np.array([[(0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (-30.0, 0.0, 0.0)]])
    case = make_case(
        {'rows': 1, 'cols': 3, 'width': 0.2, 'pins': ['0,0', '0,1'], 'stiffness.structural': 0.0,
         'damping.structural': 0.0},
        kind=kind, state=(positions, velocities))
    # The bend spring of 0.2 m between the first and the last: 0.1 m past the other end.
    mass = case.scene.node_mass
    pull = 100.0 * (0.2 - 0.3 - 0.2) + 0.05 * -30.0
    right = case.solver.right_side()[0, 2]
    if kind == 'limited':
        # The structural one is 0.1 m long, and 0.2 m past the other end: beyond its lower limit.
        pull += mass * case.law.limit_stiffness[0] * (0.1 - 0.3 - 0.8 * 0.1)
    assert right[0] == pytest.approx(-0.01 * pull / mass, rel=1e-5)


@pytest.mark.parametrize('shape', [(1, 9), (2, 2), (30, 2), (13, 16)])
def test_system_of_a_further_solve(make_case, shape, kind, geometric):
    """The second solve would take away what the first has done, or leave what it lacks."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'height': 1.3}, kind=kind, geometric=geometric,
        foresees_turn=True, tolerance=1e-4, max_iterations=300)
    case.solve()
    case.apply()
    case.prepare(is_further=True)
    assert_right_side(case)
    assert_matrix(case)


@pytest.mark.parametrize('shape', [(1, 9), (2, 2), (30, 2), (13, 16)])
@pytest.mark.parametrize('length', [0.01, 0.004])
def test_system_of_the_next_step(make_case, shape, kind, geometric, length):
    """Limits would be in force that edges do not come to, or tensions be those of another step."""
    rows, cols = shape
    case = make_case(
        {'rows': rows, 'cols': cols, 'height': 1.3}, kind=kind, geometric=geometric,
        foresees_turn=True, tolerance=1e-4, max_iterations=300)
    for further in (False, True):
        if further:
            case.prepare(is_further=True)
        case.solve()
        case.apply(further=further)
    case.law = replace(case.law, length=length)
    case.solver.set_law(case.law)
    case.prepare()
    assert_right_side(case)
    assert_matrix(case)


def test_a_new_cloth_has_the_tensions_of_its_lengths(make_case, kind):
    """The first step of a stretched cloth would blow up where later ones do not."""
    case = make_case(
        {'rows': 7, 'cols': 9}, kind=kind, geometric=BETA, foresees_turn=True, is_new=True)
    assert_right_side(case)
    assert_matrix(case)
