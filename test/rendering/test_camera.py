# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""From where the cloth is looked at, how that projects, and what a depth camera sees."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.camera import DepthCamera
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import unit_quaternion
from cloth_sim_ros.sim.scene import Scene
from cut_scene import CUT
from cut_scene import cut_snapshot
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


@pytest.mark.parametrize('field_of_view', [5.0, 25.0, 90.0])
def test_depths_of_the_device_are_distances_again(field_of_view):
    """A depth picture would be in units of the device, not in metres."""
    points = np.random.default_rng(1).uniform(-1.0, 1.0, (30, 3)) + (5.0, 0.0, -2.0)
    view = Camera(30.0, 15.0, field_of_view).looking_at(points, 320, 240)
    clip = np.append(points - view.middle, np.ones((30, 1)), axis=1) @ view.matrix.T
    depths = (clip[:, 2] / clip[:, 3] + 1.0) / 2.0
    np.testing.assert_allclose(
        view.distances(depths), view.distance - (points - view.middle) @ view.axes[2])


def some_points(seed, scale=1.0):
    """Return points of a lopsided cloud."""
    random = np.random.default_rng(seed)
    return scale * (random.normal(size=(40, 3)) * (1.0, 0.3, 0.6) + (3.0, -2.0, 0.5))


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


# A depth picture has the distance of the cloth along the axis of the camera.


@pytest.fixture
def camera():
    """Return a function that makes depth cameras, and close them."""
    made = []

    def make(points, width=80, height=60, cells=None, **angles):
        view = Camera(**angles).looking_at(points.reshape(-1, 3), width, height)
        made.append(DepthCamera(view, cells))
        return made[-1]

    yield make
    for each in made:
        each.close()


def plane(origin, right, down, rows=5, cols=7):
    """Return the positions of a flat cloth, (rows, cols, 3) [m]."""
    across = np.linspace(0.0, 1.0, cols)[None, :, None]
    along = np.linspace(0.0, 1.0, rows)[:, None, None]
    return np.asarray(origin) + across * np.asarray(right) + along * np.asarray(down)


@pytest.mark.parametrize('middle', [(0.0, 0.0, 0.0), (4096.0, -100.0, 7.0)])
def test_a_cloth_across_the_axis_has_one_depth(camera, middle):
    """A policy would see a flat cloth as a bowl, or at a wrong distance."""
    cloth = plane(np.array(middle) + (-0.5, 0.0, 0.4), (1.0, 0.0, 0.0), (0.0, 0.0, -0.8))
    eye = camera(cloth, azimuth=-90.0, elevation=0.0, field_of_view=60.0)
    seen = eye.draw(cloth)
    assert seen.shape == (60, 80) and seen.dtype == np.float32
    covered = seen < eye.far
    assert 0.7 < covered.mean() < 1.0
    np.testing.assert_allclose(seen[covered], eye.view.distance, rtol=1e-5)


@pytest.mark.parametrize('field_of_view', [20.0, 60.0, 120.0])
@pytest.mark.parametrize('azimuth, elevation', [(-90.0, 0.0), (60.0, 40.0), (250.0, -20.0)])
def test_a_tilted_cloth_has_the_depth_of_the_ray(camera, azimuth, elevation, field_of_view):
    """Slopes would be seen too steep or too shallow, or the picture be mirrored."""
    origin, right, down = map(np.array, ((-0.5, 0.1, 0.4), (1.0, 0.5, 0.1), (0.0, 0.3, -0.8)))
    cloth = plane(origin, right, down)
    eye = camera(
        cloth, azimuth=azimuth, elevation=elevation, field_of_view=field_of_view)
    seen, view = eye.draw(cloth), eye.view
    # Where the ray through the middle of each pixel meets the plane, from the pinhole alone.
    rows, cols = np.indices(seen.shape) + 0.5
    focus = view.distance / view.pixel
    rays = np.stack([
        (cols - view.width / 2) / focus, (view.height / 2 - rows) / focus, -np.ones_like(rows)],
        axis=-1) @ view.axes
    place = view.middle + view.distance * view.axes[2]
    normal = np.cross(right, down)
    depths = ((origin - place) @ normal) / (rays @ normal)
    hit = place + depths[..., None] * rays - origin
    share = hit @ np.linalg.pinv(np.stack([right, down]))
    inside = ((share > 0.02) & (share < 0.98)).all(axis=-1)
    outside = ((share < -0.02) | (share > 1.02)).any(axis=-1)
    assert inside.sum() > 100 and outside.sum() > 100
    np.testing.assert_allclose(seen[inside], depths[inside], rtol=1e-4)
    assert (seen[outside] == np.float32(eye.far)).all()


def test_the_nearer_of_two_layers_is_seen(camera):
    """A fold would be seen through."""
    cloth = plane((-0.5, 0.0, 0.4), (1.0, 0.0, 0.0), (0.0, 0.0, -0.8), rows=4)
    cloth[2:, :, 1] = 0.3   # folded up behind the upper half
    cloth[2:, :, 2] = cloth[1::-1, :, 2]
    eye = camera(cloth, azimuth=-90.0, elevation=0.0)
    seen = eye.draw(cloth)
    assert seen[30, 40] == pytest.approx(eye.view.distance - 0.15, abs=1e-4)
    # Whichever is drawn first.
    np.testing.assert_allclose(eye.draw(cloth[::-1]), seen, atol=1e-4)


def test_a_picture_says_nothing_of_the_one_before(camera):
    """A cloth that moved out of view would still be drawn."""
    cloth = plane((-0.5, 0.0, 0.4), (1.0, 0.0, 0.0), (0.0, 0.0, -0.8))
    eye = camera(cloth)
    first = eye.draw(cloth)
    assert (eye.draw(cloth + (1e3, 0.0, 0.0)) == np.float32(eye.far)).all()
    np.testing.assert_array_equal(eye.draw(cloth), first)


def rays_of(view):
    """Return where the camera is, and the ray of each pixel, 1 m forward, (height, width, 3)."""
    rows, cols = np.indices((view.height, view.width)) + 0.5
    focus = view.distance / view.pixel
    rays = np.stack([
        (cols - view.width / 2) / focus, (view.height / 2 - rows) / focus, -np.ones_like(rows)],
        axis=-1) @ view.axes
    return view.middle + view.distance * view.axes[2], rays


def test_bodies_and_planes_have_the_depth_of_the_ray(camera):
    """A policy would see a cloth in the air, or a table at a wrong distance."""
    cloth = plane((-0.5, -0.5, 0.5), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    turn = unit_quaternion((0.1, 0.05, 0.0, 1.0), 'a turn')
    ball = Collider('ball', 'sphere', (0.3,), (0.1, 0.1, 0.75), (0.0, 0.0, 0.0, 1.0), 0.3)
    floor = Collider('floor', 'plane', (), (0.0, 0.0, 0.0), turn, 0.3)
    eye = camera(cloth, azimuth=-70.0, elevation=35.0, field_of_view=60.0)
    seen = eye.draw(cloth, (ball, floor))
    place, rays = rays_of(eye.view)
    to_plane = (place[2] - 0.5) / -rays[..., 2]
    on_cloth = np.abs((place + to_plane[..., None] * rays)[..., :2]).max(axis=-1)
    normal = floor.axes[2]
    to_floor = (normal @ -place) / (rays @ normal)
    # Where the ray meets the ball: |place + t ray - centre| = radius.
    square = (rays**2).sum(axis=-1)
    half = rays @ (place - np.array(ball.position))
    rest = half**2 - square * (((place - np.array(ball.position))**2).sum() - 0.09)
    to_ball = (-half - np.sqrt(np.maximum(rest, 0.0))) / square
    expected = np.where(on_cloth < 0.5, to_plane, to_floor)
    expected = np.where(rest > 0.0, np.minimum(expected, to_ball), expected)
    # Not at outlines.
    far_from_edge = (np.abs(on_cloth - 0.5) > 0.02) & (np.abs(rest) > 0.01)
    is_finite = (to_floor > 0.0) & (expected < 0.99 * eye.far)
    assert (rest > 0.0).sum() > 100 and (on_cloth < 0.5).sum() > 100
    found = far_from_edge & is_finite
    assert found.sum() > 3000 and (expected[found] == to_floor[found]).sum() > 500
    np.testing.assert_allclose(seen[found], expected[found], atol=1e-3)


def test_a_plane_is_not_seen_from_below(camera):
    """A camera under a slope would see nothing of the cloth on it."""
    cloth = plane((-0.5, 0.0, 0.4), (1.0, 0.0, 0.0), (0.0, 0.0, -0.8))
    slope = Collider('slope', 'plane', (), (0.0, -0.5, 0.0), unit_quaternion(
        (-1.0, 0.0, 0.0, 1.0), 'a turn'), 0.3)   # its normal is y
    eye = camera(cloth, azimuth=-90.0, elevation=0.0)
    assert slope.distance(np.zeros(3)) == pytest.approx(0.5)
    np.testing.assert_array_equal(eye.draw(cloth, (slope,)), eye.draw(cloth))


def test_a_camera_without_perspective_is_refused(camera):
    """It stands nowhere: depths would be infinite."""
    with pytest.raises(ClothSimError, match='above 0 degrees'):
        camera(plane((0, 0, 0), (1, 0, 0), (0, 0, -1)), field_of_view=0.0)


def test_a_depth_camera_sees_through_holes(camera):
    """A policy would take a hole for cloth."""
    scene = Scene(CUT)
    positions = cut_snapshot(scene).positions.astype(float)
    present = positions[scene.present_nodes]
    eye = camera(present, cells=scene.cut_cells, azimuth=-90.0, elevation=90.0, field_of_view=60.0)
    depths = eye.draw(positions)
    assert depths[30, 40] == np.float32(eye.far)
    seen = depths[depths < eye.far]
    assert np.ptp(seen) < 1e-3
    # The disc is as high as the picture, about.
    whole = camera(present, azimuth=-90.0, elevation=90.0, field_of_view=60.0)
    full = whole.draw(scene.rest_positions().astype(float))
    share = len(seen) / np.count_nonzero(full < whole.far)
    area = scene.cells.count / scene.cells.present.size
    assert share == pytest.approx(area, abs=0.03)
