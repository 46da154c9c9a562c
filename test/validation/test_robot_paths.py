# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The ways of the grippers, and the scene that has one of them."""

import math

from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.validation.motions import in_air
from cloth_sim_ros.validation.motions import rag
from cloth_sim_ros.validation.motions import scene_file
from cloth_sim_ros.validation.robot_paths import DRAG
from cloth_sim_ros.validation.robot_paths import FLING
from cloth_sim_ros.validation.robot_paths import gripper_places
from cloth_sim_ros.validation.robot_paths import PATHS
from cloth_sim_ros.validation.robot_paths import timed_moves
import numpy as np
import pytest

CORNERS = np.array([[-0.25, 0.0, 1.0], [0.25, 0.0, 1.0]])


@pytest.fixture(params=PATHS.values(), ids=PATHS)
def path(request):
    """Return each way."""
    return request.param


@pytest.mark.parametrize('axis, knots', [(1, 'along'), (2, 'up')])
def test_it_comes_through_its_knots_as_they_say(path, axis, knots):
    """The grippers would go elsewhere, or faster, than those of the authors."""
    tick = 1e-4
    for time, place, speed, bend in getattr(path, knots):
        before, now, after = (
            path.offset(time + change)[axis] for change in (-tick, 0.0, tick))
        assert now == pytest.approx(place, abs=1e-12)
        if 0.0 < time < path.seconds:
            assert (after - before) / (2.0 * tick) == pytest.approx(speed, abs=1e-3)
        earlier = path.offset(time - 2.0 * tick)[axis]
        if time > 0.0:
            assert (now - 2.0 * before + earlier) / tick**2 == pytest.approx(bend, abs=0.02)


@pytest.mark.parametrize('path, time', [(FLING, 0.5), (FLING, 1.3), (FLING, 3.0), (DRAG, 5.0)])
def test_it_is_where_a_solved_polynomial_is(path, time):
    """The form of the polynomials would be wrong between the knots."""
    for axis, knots in ((1, path.along), (2, path.up)):
        (begin, *at_begin), (end, *at_end) = next(
            pair for pair in zip(knots, knots[1:]) if pair[0][0] <= time <= pair[1][0])
        rows = [
            [0.0] * order + [
                math.perm(power, order) * moment ** (power - order)
                for power in range(order, 6)]
            for moment in (0.0, end - begin) for order in range(3)]
        factors = np.linalg.solve(rows, [*at_begin, *at_end])
        solved = np.polyval(factors[::-1], time - begin)
        assert path.offset(time)[axis] == pytest.approx(solved, abs=1e-9)


def test_the_grippers_close_in_and_stay_level(path):
    """The rag would be torn, or turned, before it is moved."""
    for time in np.arange(0.0, path.lead + path.seconds, 0.05):
        left, right = gripper_places(path, CORNERS, time)
        assert left[1:] == pytest.approx(right[1:])
        assert 0.478 - 1e-9 <= right[0] - left[0] <= 0.5 + 1e-9
    assert gripper_places(path, CORNERS, 0.0) == pytest.approx(CORNERS)


def test_the_scene_has_the_fling():
    """The shipped scene would show another motion than the page describes."""
    given = load_parameters(scene_file())
    for name, values in timed_moves(FLING, CORNERS, 10.0).items():
        assert given[f'pin_moves.{name}'] == values
    assert not any(name.startswith('pin_moves') for name in rag(0.05, 'constraint', 10.0))


def test_how_long_the_rag_is_above_the_table():
    """The page would compare a cloth in the air with one on a table."""
    values = rag(0.05, 'mass_spring', 10.0)
    assert in_air(FLING, values) == pytest.approx(3.19)
    assert in_air(DRAG, values) == pytest.approx(5.02)
