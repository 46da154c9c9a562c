# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""From where the cloth is looked at, how that projects, and what a depth camera sees."""

from itertools import product

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.sim.errors import ClothSimError
from hypothesis import given
from hypothesis import strategies
import numpy as np
import pytest

ANGLES = strategies.tuples(
    strategies.floats(-360.0, 360.0), strategies.floats(-90.0, 90.0))
VIEWS = strategies.sampled_from([0.0, 10.0, 40.0, 120.0])
SIZES = strategies.sampled_from([(400, 300), (100, 300), (640, 200)])


@pytest.mark.parametrize('field_of_view', [0.0, 25.0, 90.0])
def test_the_matrix_puts_points_where_project_says(field_of_view):
    """Words and marks would stand beside what they belong to."""
    points = np.random.default_rng(0).uniform(-1.0, 1.0, (30, 3)) + (5.0, 0.0, -2.0)
    view = Camera(30.0, 15.0, field_of_view, zoom=1.3).looking_at(points, 320, 240)
    clip = np.append(points - view.middle, np.ones((30, 1)), axis=1) @ view.matrix.T
    device = clip[:, :3] / clip[:, 3:]
    pixels = (device[:, :2] * (1.0, -1.0) + 1.0) / 2.0 * (320.0, 240.0)
    np.testing.assert_allclose(pixels, view.project(points))
    # All of it lies between the near and the far end, and what is nearer comes first.
    assert (np.abs(device[:, 2]) < 1.0).all()
    near = (points - view.middle) @ view.axes[2]
    assert (np.diff(device[np.argsort(-near), 2]) > 0.0).all()


def some_points(seed, scale=1.0):
    """Return points of a lopsided cloud."""
    random = np.random.default_rng(seed)
    return scale * (random.normal(size=(40, 3)) * (1.0, 0.3, 0.6) + (3.0, -2.0, 0.5))


@pytest.mark.parametrize('field_of_view', [0.0, 25.0, 90.0])
def test_what_is_beyond_a_side_cannot_be_shown(field_of_view):
    """A legend would name a mark that is outside the picture, or lack one that is inside."""
    corners = np.array(list(product((-0.1, 0.1), repeat=3)))
    view = Camera(30.0, 15.0, field_of_view).looking_at(10.0 * corners, 320, 240)
    right, up, _ = view.axes
    for side, half in ((right, view.half_height * 320 / 240), (up, view.half_height)):
        for sign in (-1.0, 1.0):
            # 1.3 and 0.7 of the way to the side, at the distance of the middle.
            assert view.may_show(view.middle + corners + 0.7 * sign * half * side)
            assert not view.may_show(view.middle + 0.1 * corners + 1.3 * sign * half * side)
    # Larger than the picture on all sides, though no corner is in it.
    assert view.may_show(view.middle + (corners * (100.0, 100.0, 0.1)) @ view.axes)
    assert not view.may_show(np.zeros((0, 3)))


@given(ANGLES)
def test_it_neither_stretches_nor_mirrors(angles):
    """A square cloth would look like a rectangle, or like its mirror image."""
    axes = Camera(*angles).axes
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)


@given(strategies.floats(-360.0, 360.0), strategies.floats(-89.0, 89.0))
def test_z_is_up_in_the_view(azimuth, elevation):
    """The cloth would hang sideways or upwards."""
    right, up, _ = Camera(azimuth, elevation).axes @ (0.0, 0.0, 1.0)
    assert right == pytest.approx(0.0, abs=1e-12)
    assert up > 0.0


def test_it_stands_where_it_is_told():
    """Near and far would be swapped, and the back of the cloth drawn over its front."""
    np.testing.assert_allclose(Camera(90.0, 0.0).axes @ (0.0, 1.0, 0.0), [0, 0, 1], atol=1e-12)
    np.testing.assert_allclose(Camera(0.0, 90.0).axes @ (0.0, 0.0, 1.0), [0, 0, 1], atol=1e-12)
    # Seen along y from in front of the cloth, x goes to the right.
    assert (Camera(-90.0, 0.0).axes @ (1.0, 0.0, 0.0))[0] == pytest.approx(1.0)


@given(
    ANGLES, VIEWS, SIZES, strategies.integers(0, 50), strategies.sampled_from([1e-2, 1.0, 1e3]))
def test_everything_is_in_view_and_fills_it(angles, field_of_view, size, seed, scale):
    """A part of the cloth would be cut off, or the cloth be a speck in the middle."""
    points = some_points(seed, scale)
    view = Camera(*angles, field_of_view).looking_at(points, *size)
    seen = view.project(points)
    assert (seen > 0.0).all() and (seen < size).all()
    if field_of_view > 90.0:  # So wide a camera has to keep away from what is near.
        return
    # It reaches nearly from one side to the other, across or down, and is in the middle.
    room = np.stack([seen.min(axis=0), size - seen.max(axis=0)]) / size
    tight = room.max(axis=0).argmin()
    assert room[:, tight].max() < 0.03


def test_parts_twice_as_far_look_half_as_large():
    """The perspective would be another than the field of view says."""
    points = np.array([[0.0, -1.0, -1.0], [0.0, -1.0, 1.0], [0.0, 1.0, -1.0], [0.0, 1.0, 1.0]])
    view = Camera(90.0, 0.0, 90.0).looking_at(points, 200, 200)
    far, near = (np.ptp(view.project(points[pair])[:, 1]) for pair in ([0, 1], [2, 3]))
    distance = view.distance
    assert near / far == pytest.approx((distance + 1.0) / (distance - 1.0))
    # A right angle shows as much to each side as it is far away.
    assert view.half_height == pytest.approx(distance)


def test_without_perspective_near_and_far_are_alike():
    """Lengths could not be measured in the picture."""
    points = some_points(0)
    view = Camera(20.0, 30.0, 0.0).looking_at(points, 300, 200)
    lengths = np.linalg.norm(np.diff(points @ view.axes[:2].T, axis=0), axis=1)
    seen = np.linalg.norm(np.diff(view.project(points), axis=0), axis=1)
    np.testing.assert_allclose(seen * view.pixel, lengths)


def test_zoom_enlarges_around_the_target():
    """A detail could not be looked at."""
    points = some_points(1)
    target = tuple(points[3])
    views = [
        Camera(zoom=zoom, target=target).looking_at(points, 300, 200) for zoom in (1.0, 4.0)]
    for view in views:
        np.testing.assert_allclose(view.project(points[3]), [150.0, 100.0])
    one, four = (view.project(points) - (150.0, 100.0) for view in views)
    np.testing.assert_allclose(four, 4.0 * one)
    assert (np.abs(one) < (150.0, 100.0)).all()


def test_a_single_point_can_be_looked_at():
    """A cloth of one node would end in a division by zero."""
    view = Camera().looking_at(np.array([[1.0, 2.0, 3.0]]), 64, 48)
    np.testing.assert_allclose(view.project(np.array([1.0, 2.0, 3.0])), [32.0, 24.0])


@pytest.mark.parametrize(('wrong', 'rule'), [
    ({'field_of_view': 180.0}, 'field of view must be from 0 to 150 degrees, got 180'),
    ({'field_of_view': -1.0}, 'field of view'),
    ({'zoom': 0.0}, 'zoom must be above 0'),
    ({'azimuth': float('nan')}, 'finite'),
    ({'target': (0.0, float('inf'), 0.0)}, 'finite'),
])
def test_a_camera_that_sees_nothing_is_refused(wrong, rule):
    """The picture would be empty, and nobody told why."""
    with pytest.raises(ClothSimError, match=rule):
        Camera(**wrong)


@pytest.mark.parametrize('angles', [
    {}, {'azimuth': 60.0, 'elevation': 40.0, 'field_of_view': 60.0},
    {'azimuth': 250.0, 'elevation': -20.0, 'field_of_view': 120.0, 'zoom': 2.0},
    {'elevation': 90.0}])
def test_its_pinhole_sees_the_same_view(angles):
    """Depth observations would be of another place than the pictures beside them."""
    points = np.random.default_rng(2).uniform(-1.0, 1.0, (50, 3)) + (3.0, -1.0, 2.0)
    view = Camera(**angles).looking_at(points, 80, 60)
    pinhole = view.pinhole()
    inside = points[pinhole.pose.seen_from(points)[:, 2] > pinhole.near]
    # A view counts from the corner of a pixel, a pinhole from its middle.
    np.testing.assert_allclose(
        pinhole.project(pinhole.pose.seen_from(inside)) + 0.5, view.project(inside), atol=1e-6)
    assert len(inside) > 25


def test_a_view_without_perspective_has_no_pinhole():
    """It stands nowhere: depths would be infinite."""
    view = Camera(field_of_view=0.0).looking_at(np.eye(3), 8, 6)
    with pytest.raises(ClothSimError, match='above 0 degrees'):
        view.pinhole()
