# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Where the frames of colliders and grasps are at each time."""

import math

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.frame_paths import FrameMove
from cloth_sim_ros.sim.model.frame_paths import FramePaths
from cloth_sim_ros.sim.model.pose import Pose
import numpy as np
import pytest

HERE = Pose((0.0, 0.0, 0.0))


def a_move(target, start, *, speed=1.0, orientation=None, angular_speed=1.0, name='ball'):
    """Return a checked move of a frame."""
    return FrameMove.checked(
        name=name, target=target, orientation=orientation, speed=speed,
        angular_speed=angular_speed, start=start)


def about_z(angle):
    """Return the quaternion of a rotation about z."""
    return 0.0, 0.0, math.sin(angle / 2.0), math.cos(angle / 2.0)


def test_a_move_ends_at_its_target():
    """A body would not be where the scene says, or never stop."""
    paths = FramePaths({'ball': HERE}, [
        a_move((0.0, 0.0, 1.0), 1.0, speed=2.0), a_move((1.0, 0.0, 0.5), 1.25)])
    assert paths.quiet_until(0.0) == 1.0
    assert paths.quiet_until(1.1) == 1.1
    np.testing.assert_allclose(paths.pose('ball', 1.25).position, [0.0, 0.0, 0.5])
    np.testing.assert_allclose(paths.pose('ball', 1.75).position, [0.5, 0.0, 0.5])
    np.testing.assert_allclose(
        paths.motions(['ball'], 1.3, 1.4).velocities, [[1.0, 0.0, 0.0]])
    assert paths.pose('ball', 9.0).position == (1.0, 0.0, 0.5)
    np.testing.assert_allclose(paths.motions(['ball'], 9.0, 9.1).velocities, 0.0)
    assert paths.quiet_until(9.0) == math.inf


@pytest.mark.parametrize(('angular_speed', 'arrival'), [(10.0, 3.0), (0.25, 4.0)])
def test_way_and_rotation_end_together(angular_speed, arrival):
    """A gripper would arrive turned too far, or faster than it may be."""
    paths = FramePaths({'ball': HERE}, [a_move(
        (3.0, 0.0, 0.0), 0.0, orientation=about_z(1.0), angular_speed=angular_speed)])
    half = paths.pose('ball', 0.5 * arrival)
    np.testing.assert_allclose(half.position, [1.5, 0.0, 0.0])
    np.testing.assert_allclose(half.orientation, about_z(0.5))
    assert paths.quiet_until(arrival - 0.01) == arrival - 0.01
    assert paths.quiet_until(arrival) == math.inf
    np.testing.assert_allclose(paths.pose('ball', arrival).orientation, about_z(1.0))


def test_it_turns_the_shorter_way():
    """A quaternion and its negative are one orientation: a body would turn once more for one."""
    far = FramePaths({'ball': HERE}, [a_move(
        (0.0, 0.0, 0.0), 0.0, orientation=[-part for part in about_z(0.5)])])
    np.testing.assert_allclose(far.pose('ball', 0.25).orientation, about_z(0.25))


def test_a_turn_takes_an_arm_to_where_it_ends():
    """What sticks to a body that turns would creep outwards."""
    paths = FramePaths({'ball': HERE}, [a_move((0.0, 0.0, 0.0), 0.0, orientation=about_z(1.0))])
    arm = np.array([2.0, 0.0, 1.0])
    velocity = paths.motions(['ball'], 0.0, 0.5).turns @ arm
    np.testing.assert_allclose(
        arm + 0.5 * velocity, [2.0 * math.cos(0.5), 2.0 * math.sin(0.5), 1.0])
    np.testing.assert_allclose(np.linalg.norm(
        paths.pose('ball', 0.5).in_world(np.array([[2.0, 0.0, 1.0]]))[0] - arm - 0.5 * velocity),
        0.0, atol=1e-12)


def test_one_added_on_the_way_begins_there():
    """A new target would make a body jump, or drop the scheduled moves of the scene."""
    paths = FramePaths({'ball': HERE}, [
        a_move((1.0, 0.0, 0.0), 0.0), a_move((0.0, 0.0, 5.0), 3.0)])
    added = paths.add(a_move((0.5, 1.0, 0.0), 0.5))
    assert added.arrival == 1.5
    np.testing.assert_allclose(paths.pose('ball', 0.4).position, [0.4, 0.0, 0.0])
    np.testing.assert_allclose(paths.pose('ball', 1.0).position, [0.5, 0.5, 0.0])
    # The one that comes later sets off from where the body is by then.
    np.testing.assert_allclose(
        paths.pose('ball', 3.0).position, [0.5, 1.0, 0.0], atol=1e-12)
    assert paths.pose('ball', 99.0).position == (0.0, 0.0, 5.0)


def test_the_first_of_several_ends_the_quiet():
    """A body that sets off before another would be taken to rest until that one does."""
    paths = FramePaths({'ball': HERE, 'box': HERE}, [
        a_move((1.0, 0.0, 0.0), 1.0),
        FrameMove.checked(name='box', target=(1.0, 0.0, 0.0), orientation=None, speed=1.0,
                          angular_speed=1.0, start=2.0)])
    assert paths.quiet_until(0.0) == 1.0


@pytest.mark.parametrize(('duration', 'arrival'), [(0.0, 2.0), (1.0, 2.0), (4.0, 4.0)])
def test_a_move_can_be_given_its_duration(duration, arrival):
    """A streamed body would arrive before its next pose and stop, or be faster than it may."""
    move = a_move((1.0, 0.0, 0.0), 0.0, speed=0.5, orientation=about_z(1.0)).slowed(duration, HERE)
    paths = FramePaths({'ball': HERE})
    added = paths.add(move)
    assert added.arrival == pytest.approx(arrival)
    assert move.speed <= 0.5 and move.angular_speed <= 1.0
    assert FramePaths({'ball': HERE}).add(a_move(
        move.target, 0.0, speed=move.speed, orientation=move.orientation,
        angular_speed=move.angular_speed)).arrival == added.arrival


def test_a_move_of_no_way_can_be_given_its_duration():
    """A stream that stands still would be refused, for its speed of 0."""
    move = a_move((0.0, 0.0, 0.0), 0.0).slowed(0.1, HERE)
    assert FramePaths({'ball': HERE}).add(move).arrival == 0.0
    FrameMove.checked(
        name='ball', target=move.target, orientation=None, speed=move.speed,
        angular_speed=move.angular_speed, start=0.0)


def test_frames_that_differ_are_found():
    """A recording that begins late would have a body where its scene has it."""
    timed = a_move((1.0, 0.0, 0.0), 0.0, speed=0.5)
    scene, run = (
        FramePaths({'ball': HERE, 'floor': HERE}, [timed]) for _ in range(2))
    assert run.differing(scene, 1.0) == ()
    path = run.add(a_move((1.0, 0.0, 0.0), 0.5, speed=0.25))
    moved, = run.differing(scene, 1.0)
    assert (moved.name, moved.path) == ('ball', path)
    np.testing.assert_allclose(moved.pose.position, [0.375, 0.0, 0.0])
    # Both have arrived.
    assert run.differing(scene, 9.0) == ()


@pytest.mark.parametrize(('values', 'rule'), [
    ({'speed': 0.0}, 'the speed of ball must be from 1e-06'),
    ({'angular_speed': math.nan}, 'the angular_speed of ball must be'),
    ({'target': (0.0, 1.0)}, 'must be 3 finite numbers'),
    ({'target': (0.0, 0.0, math.inf)}, 'must be 3 finite numbers'),
    ({'orientation': (0.0, 0.0, 0.0, 0.0)}, 'has no direction'),
    ({'orientation': (0.0, 0.0, 1.0)}, 'needs 4 finite numbers')])
def test_bad_moves_are_refused(values, rule):
    """A body would leave for nowhere, or never arrive."""
    with pytest.raises(ClothSimError, match=rule):
        a_move(**{'target': (0.0, 0.0, 0.0), 'start': 0.0, **values})


def test_a_long_name_is_cut():
    """An answer would be as long as what a client sent."""
    with pytest.raises(ClothSimError) as found:
        a_move(name=5000 * 'a', target=(0.0, 0.0, 0.0), speed=0.0, start=0.0)
    assert len(str(found.value)) < 400
