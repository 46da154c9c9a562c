# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Positions and orientations of bodies."""

from cloth_sim_ros.sim.model.pose import axes_of_each
from cloth_sim_ros.sim.model.pose import between
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.model.pose import rotated
from cloth_sim_ros.sim.model.pose import rotated_each
from cloth_sim_ros.sim.model.pose import turned
from cloth_sim_ros.sim.model.pose import unit_quaternion
import numpy as np
from scipy.spatial.transform import Rotation


def test_a_unit_quaternion_keeps_its_bits():
    """A recorded move would turn by other bits when it is made again."""
    generator = np.random.default_rng(3)
    for given in generator.normal(size=(2000, 4)):
        unit = unit_quaternion(given, 'it')
        assert unit_quaternion(unit, 'it') == unit
        np.testing.assert_allclose(unit, given / np.linalg.norm(given), rtol=1e-15)
        later = rotated(unit, (0.6, 0.0, 0.8), float(given[0]))
        assert unit_quaternion(later, 'it') == later


def test_poses_in_one_another():
    """What is given in a moved frame would be taken elsewhere, or turned the other way."""
    generator = np.random.default_rng(4)
    for _ in range(100):
        turns = Rotation.random(2, random_state=generator)
        places = generator.normal(size=(2, 3))
        outer, inner = (
            Pose(tuple(place), tuple(turn.as_quat())) for place, turn in zip(places, turns))
        found = outer.placed(inner)
        np.testing.assert_allclose(
            found.position, places[0] + turns[0].apply(places[1]), atol=1e-14)
        np.testing.assert_allclose(found.axes.T, (turns[0] * turns[1]).as_matrix(), atol=1e-14)
        np.testing.assert_allclose(
            turned((1.0, -2.0, 0.5), outer.orientation), turns[0].apply((1.0, -2.0, 0.5)),
            atol=1e-14)
        home = outer.inverse.placed(outer)
        np.testing.assert_allclose(home.position, 0.0, atol=1e-14)
        np.testing.assert_allclose(home.axes, np.eye(3), atol=1e-14)


def test_the_ends_of_a_way_between_poses():
    """A frame would jump where one pair of samples ends and the next begins."""
    first, last = Pose((1.0, 2.0, 3.0)), Pose((2.0, 2.0, 5.0), (0.0, 0.6, 0.0, 0.8))
    assert between(first, last, 0.0) == first
    assert between(first, last, 1.0).position == last.position
    np.testing.assert_allclose(
        between(first, last, 1.0).orientation, last.orientation, atol=1e-15)


def test_many_are_turned_to_the_bits_of_each():
    """A body of a batch would turn by other bits than in a run of its own."""
    random = np.random.default_rng(7)
    orientations = [unit_quaternion(each, 'it') for each in random.normal(size=(500, 4))]
    axes = random.normal(size=(500, 3))
    axes /= np.linalg.norm(axes, axis=-1)[:, None]
    angles = random.uniform(-4.0, 4.0, 500)
    turned_each = rotated_each(np.array(orientations), axes, angles)
    expected = [
        rotated(*each) for each in zip(orientations, axes.tolist(), angles.tolist())]
    np.testing.assert_array_equal(turned_each, expected)
    np.testing.assert_array_equal(
        axes_of_each(turned_each), [Pose((0.0, 0.0, 0.0), each).axes for each in expected])
