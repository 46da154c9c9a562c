# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What a camera sees is what its pinhole and the shapes say, by formula."""

from cloth_sim_ros.camera.camera import Camera
from cloth_sim_ros.gl.inventory import take_inventory
from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import Pose
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
from cloth_sim_ros.sim.snapshot import FLAG_GAP
import numpy as np
import pytest
from seen_by_formula import meet_plane
from seen_by_formula import meet_sphere
from seen_by_formula import meet_triangles
from seen_by_formula import rays_of
from seen_by_formula import triangles_of
from seen_cloths import ASIDE
from seen_cloths import FALLING
from seen_cloths import plane_cloth
from seen_cloths import snapshot_of

FAR_AWAY = plane_cloth((0.0, 0.0, -50.0), (0.1, 0.0, 0.0), (0.0, -0.1, 0.0))
UNTURNED = (0.0, 0.0, 0.0, 1.0)
ROUNDING = 3e-6  # of float32, over the depth [1]


def body(name, shape, size, position, orientation=UNTURNED):
    """Return a collider."""
    return Collider(name, shape, tuple(size), tuple(position), orientation, 0.3)


def in_camera(picture, points):
    """Return ``points`` of the world in the optical frame, float64."""
    return picture.pose.seen_from(np.asarray(points, float))


@pytest.mark.parametrize('away', [(0.0, 0.0, 0.0), (4096.0, -100.0, 7.0)])
@pytest.mark.parametrize('intrinsics', [[], [150.0, 190.0, 70.25, 64.5]])
def test_tilted_cloth_has_the_depth_of_the_rays(camera, away, intrinsics):
    """Slopes would be seen too steep, or far from the origin in steps of float32."""
    cloth = plane_cloth(
        np.array(away) + (-0.5, 0.1, 0.4), (1.0, 0.5, 0.125), (0.0, 0.375, -0.75))
    # Where nodes are is known to float32 only.
    cloth = cloth.astype(np.float32).astype(float)
    eye = camera(
        position=list(np.array(away) + (0.3, -1.5, 0.7)), target=list(np.array(away)),
        width=160, height=120, intrinsics=intrinsics)
    picture = eye.capture(snapshot_of(cloth))
    seen = in_camera(picture, cloth)
    expected = meet_triangles(rays_of(eye.model), triangles_of(seen)).reshape(120, 160)
    both = np.isfinite(expected) & np.isfinite(picture.depth)
    assert 0.1 < both.mean() < 0.9
    np.testing.assert_allclose(picture.depth[both], expected[both], rtol=ROUNDING)


def test_surface_is_drawn_where_nodes_are_projected(camera, fallen):
    """A detector would learn corners that are a pixel off what camera_info says."""
    eye = camera(**ASIDE)
    picture = eye.capture(fallen.snapshot())
    triangles = triangles_of(in_camera(picture, fallen.positions()))
    # The model of image_geometry: u = fx X / Z + cx, with the middle of a pixel at a whole u.
    corners = triangles[..., :2] / triangles[..., 2:]
    pixels = corners * (eye.model.fx, eye.model.fy) + (eye.model.cx, eye.model.cy)
    np.testing.assert_allclose(eye.model.project(triangles), pixels, rtol=1e-12)
    # A thousandth of a pixel around each triangle may be one or the other.
    size = np.ptp(pixels, axis=1).max()
    outside = meet_triangles(rays_of(eye.model), triangles, edge=1e-3 / size * 10.0)
    inside = meet_triangles(rays_of(eye.model), triangles, edge=-1e-3 / size * 10.0)
    drawn = (picture.labels == 1).ravel()
    assert drawn.sum() > 500
    assert not (drawn & np.isinf(outside)).any()
    assert not (~drawn & np.isfinite(inside)).any()
    agreed = drawn & np.isfinite(inside) & (outside == inside)
    assert agreed.sum() > 0.8 * drawn.sum()
    # Next to the outline of a fold, a ray along a facet loses digits.
    np.testing.assert_allclose(
        picture.depth.ravel()[agreed], outside[agreed], rtol=1e-4)
    off = np.abs(picture.depth.ravel()[agreed] / outside[agreed] - 1.0)
    assert np.percentile(off, 99.0) < ROUNDING


def test_sphere_has_the_depth_of_the_rays(camera):
    """A ball would be a polyhedron."""
    eye = camera(**ASIDE)
    ball = body('ball', 'sphere', [0.3], (0.1, -0.1, 0.3))
    picture = eye.capture(snapshot_of(FAR_AWAY), colliders=[ball])
    expected = meet_sphere(
        rays_of(eye.model), in_camera(picture, ball.position), 0.3).reshape(120, 160)
    drawn = picture.labels == 2
    edge = np.zeros_like(drawn)
    for reach in (-0.5, 0.5):
        grown = meet_sphere(
            rays_of(eye.model), in_camera(picture, ball.position),
            0.3 + reach * 1.5 / eye.model.fx).reshape(120, 160)
        edge |= np.isfinite(grown) != np.isfinite(expected)
    assert drawn.sum() > 500
    # Its outline to half a pixel, and inside of it each depth.
    assert (drawn == np.isfinite(expected))[~edge].all()
    both = drawn & np.isfinite(expected) & ~edge
    np.testing.assert_allclose(picture.depth[both], expected[both], rtol=ROUNDING)


def test_tilted_plane_has_the_depth_of_the_rays(camera):
    """A table would be bent, or end where its triangles do."""
    eye = camera(**ASIDE)
    table = body('table', 'plane', [], (0.2, 0.1, -0.1), (0.2, -0.1, 0.0, 0.9746794))
    picture = eye.capture(snapshot_of(FAR_AWAY), colliders=[table])
    normal = picture.pose.axes @ table.axes[2]
    expected = meet_plane(
        rays_of(eye.model), in_camera(picture, table.position), normal).reshape(120, 160)
    seen = expected < eye.model.far
    assert seen.mean() > 0.5
    np.testing.assert_allclose(picture.depth[seen], expected[seen], rtol=ROUNDING)
    assert np.isposinf(picture.depth[~seen]).all()
    np.testing.assert_allclose(
        picture.normals[seen], np.broadcast_to(normal, (seen.sum(), 3)), atol=1e-6)


def test_a_plane_is_not_seen_from_below(camera):
    """A camera under a slope would see nothing of the cloth on it."""
    eye = camera(position=[0.0, 0.0, -1.0], target=[0.0, 0.1, 0.0], width=16, height=12)
    table = body('table', 'plane', [], (0.0, 0.0, 0.0))
    picture = eye.capture(snapshot_of(FAR_AWAY), colliders=[table])
    assert (picture.labels == 0).all() and (picture.color == picture.color[0, 0]).all()


@pytest.mark.parametrize('shape, size', [
    ('box', [0.3, 0.4, 0.5]), ('cylinder', [0.2, 0.5]), ('capsule', [0.15, 0.4])])
def test_bodies_are_seen_where_their_surface_is(camera, shape, size):
    """A gripper would reach beside a body of another shape than the cloth touches."""
    eye = camera(**ASIDE)
    solid = body('solid', shape, size, (0.1, 0.0, 0.2), (0.3, -0.2, 0.4, 0.8426150))
    picture = eye.capture(snapshot_of(FAR_AWAY), colliders=[solid])
    drawn = picture.labels == 2
    assert drawn.sum() > 500
    world = picture.pose.in_world(picture.points()[drawn].astype(float))
    assert np.abs(solid.distance(world)).max() < 2e-6
    # No ray that passes the body by goes through it, and none that meets it is left out.
    rays = rays_of(eye.model).reshape(120, 160, 3)
    least = np.min([
        solid.distance(picture.pose.in_world(depth * rays.reshape(-1, 3)))
        for depth in np.linspace(0.8, 3.0, 400)], axis=0).reshape(120, 160)
    # Between two of these points a ray comes nearer by up to half of their distance.
    assert (least[~drawn] > -0.01).all() and (least[drawn] < 4e-3).all()
    # Its normals point outwards, along the gradient of the distance.
    step = 1e-4
    outward = (picture.normals[drawn].astype(float)) @ picture.pose.axes
    rise = solid.distance(world + step * outward) - solid.distance(world)
    assert np.percentile(rise, 2.0) > 0.98 * step


@pytest.mark.parametrize('position', [(0.0, 0.0, 0.2), (0.05, 0.0, 0.1)])
def test_nothing_is_seen_from_inside_of_a_body(camera, position):
    """A camera in a gripper that touches a ball would see nothing else."""
    eye = camera(position=list(position), target=[1.0, 0.0, 0.2], width=16, height=12)
    ball = body('ball', 'sphere', [0.3], (0.0, 0.0, 0.2))
    picture = eye.capture(snapshot_of(FAR_AWAY), colliders=[ball])
    assert (picture.labels == 0).all()


def test_a_ball_hides_the_nodes_behind_it(camera):
    """A planner would grasp nodes that no sensor sees."""
    eye = camera(position=[0.0, -2.0, 0.0], target=[0.0, 0.0, 0.0], width=160, height=120)
    cloth = plane_cloth((-0.5, 0.3, 0.5), (1.0, 0.0, 0.0), (0.0, 0.4, -1.0), 21, 23)
    ball = body('ball', 'sphere', [0.2], (0.1, -0.2, 0.1))
    picture = eye.capture(snapshot_of(cloth), colliders=[ball])
    nodes = in_camera(picture, cloth).reshape(-1, 3)
    rays = nodes / nodes[:, 2:]
    pixel = 2.0 / eye.model.fx
    hidden, narrow, wide = (
        np.isfinite(meet_sphere(rays, in_camera(picture, ball.position), radius))
        for radius in (0.2, 0.2 - pixel, 0.2 + pixel))
    clear = narrow == wide
    assert 50 < hidden[clear].sum() < 0.5 * clear.sum() and clear.mean() > 0.9
    np.testing.assert_array_equal(picture.visible.ravel()[clear], ~hidden[clear])


def test_a_layer_hides_the_one_a_millimetre_below(camera):
    """A folded towel would look as if each of its layers were on top."""
    lower = plane_cloth((-0.3, 0.3, 0.0), (0.6, 0.0, 0.0), (0.0, -0.3, 0.0), 7, 13)
    upper = plane_cloth((-0.3, 0.0, 0.001), (0.6, 0.0, 0.0), (0.0, 0.29, 0.0), 7, 13)
    eye = camera(position=[0.3, -0.6, 0.8], target=[0.0, 0.15, 0.0])
    picture = eye.capture(snapshot_of(np.concatenate([lower, upper])))
    assert picture.visible[7:].all()
    # Row 0 of the lower layer looks out from below the upper one.
    assert picture.visible[0].all() and not picture.visible[1:6, 1:-1].any()


def test_labels_add_up_to_the_picture(camera, fallen):
    """Some pixels would be of nothing and of something, or of a body that is not there."""
    picture = camera(**ASIDE).capture(fallen)
    assert picture.label_names == ('background', 'cloth', 'ball', 'ground')
    counts = np.bincount(picture.labels.ravel(), minlength=4)
    assert counts.sum() == 120 * 160 and len(counts) == 4
    assert counts[1] > 500 and counts[3] > 500
    np.testing.assert_array_equal(picture.labels == 0, np.isposinf(picture.depth))
    np.testing.assert_array_equal(
        picture.labels == 0, np.isnan(picture.normals).any(axis=-1))
    world = picture.pose.in_world(picture.points().astype(float))
    for label, collider in enumerate(fallen.colliders, 2):
        of_body = picture.labels == label
        assert np.abs(collider.distance(world[of_body])).max(initial=0.0) < 1e-5


def test_points_are_the_inverse_of_k_times_depth(camera, fallen):
    """Clouds and depth pictures of one moment would not lie on each other."""
    eye = camera(**ASIDE)
    picture = eye.capture(fallen)
    v, u = np.indices(picture.depth.shape)
    pixels = np.stack([u, v, np.ones_like(u)], axis=-1)
    expected = (np.linalg.inv(eye.model.matrix) @ pixels[..., None])[..., 0] * np.where(
        np.isfinite(picture.depth), picture.depth, np.nan)[..., None]
    points = picture.points()
    assert points.dtype == np.float32
    np.testing.assert_allclose(points, expected, rtol=1e-6, atol=1e-6)


def test_what_is_too_near_or_too_far_says_so(camera):
    """A planner would take the limit of the sensor for a wall (REP 117)."""
    cloth = plane_cloth((-0.5, 0.5, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    values = {'position': [0.0, 0.0, 1.0], 'target': [0.0, 0.0, 0.0], 'width': 32, 'height': 24}
    near = camera(**values, near=1.1, far=2.0).capture(snapshot_of(cloth))
    assert (near.labels[8:16, 8:24] == 1).all() and np.isneginf(near.depth[8:16, 8:24]).all()
    assert np.isnan(near.points()[12, 16]).all()
    far = camera(**values, near=0.1, far=0.9).capture(snapshot_of(cloth))
    assert (far.labels == 0).all() and np.isposinf(far.depth).all()


def test_simulation_and_snapshot_look_alike(camera, fallen):
    """Nodes read on the device would be others than those that are published."""
    eye = camera(**ASIDE)
    live = eye.capture(fallen)
    still = eye.capture(fallen.snapshot(), colliders=fallen.colliders)
    for part in ('depth', 'labels', 'normals', 'visible'):
        np.testing.assert_array_equal(getattr(live, part), getattr(still, part), part)
    # How far cloth is seen in front of bodies goes by its cells, at rest or as they are.
    assert (live.color == still.color).all(axis=-1).mean() > 0.999
    assert live.time == still.time == fallen.time


def test_a_cut_cloth_has_its_hole(camera):
    """A towel with a hole would look whole."""
    cloth = plane_cloth((-0.4, 0.4, 0.0), (0.8, 0.0, 0.0), (0.0, -0.8, 0.0), 5, 5)
    flags = np.zeros((5, 5), np.uint32)
    flags[1, 2] = FLAG_GAP
    eye = camera(position=[0.0, 0.0, 1.0], target=[0.0, 0.0, 0.0], width=120, height=120)
    picture = eye.capture(snapshot_of(cloth, flags))
    hole = eye.model.project(in_camera(picture, cloth[[1, 2], [2, 3]]))
    v, u = np.indices((120, 120))
    inside = (u > hole[0, 0]) & (u < hole[1, 0]) & (v > hole[0, 1]) & (v < hole[1, 1])
    whole = eye.capture(snapshot_of(cloth))
    np.testing.assert_array_equal(picture.labels == 1, (whole.labels == 1) & ~inside)


def test_two_runs_take_the_same_pictures():
    """A data set could not be made again, and no difference would mean anything."""
    pictures = []
    for _ in range(2):
        with Simulation(Scene(FALLING)) as simulation, Camera(**ASIDE) as eye:
            simulation.advance(0.3)
            pictures.append(eye.capture(simulation))
    for part in ('color', 'depth', 'labels', 'normals', 'visible'):
        one, other = (getattr(picture, part).tobytes() for picture in pictures)
        assert one == other, part


def test_pictures_leave_the_run_as_it_is():
    """A camera would change what it looks at."""
    hashes = []
    for looks in (False, True):
        with Simulation(Scene(FALLING)) as simulation, Camera(**ASIDE) as eye:
            for _ in range(6):
                simulation.advance(0.05)
                if looks:
                    eye.capture(simulation)
            hashes.append(simulation.snapshot().state_sha256)
    assert hashes[0] == hashes[1]


def test_a_camera_that_takes_no_picture_costs_nothing():
    """A scene with cameras would compile and allocate for nobody."""
    with_camera = {
        **FALLING, 'cameras.names': ['front'],
        **{f'cameras.front.{name}': value for name, value in ASIDE.items()}}
    found = []
    for values in (FALLING, with_camera):
        with take_inventory() as inventory, Simulation(Scene(values)) as simulation:
            simulation.advance(0.1)
            found.append((
                simulation.snapshot().state_sha256, len(inventory.programs),
                inventory.buffer_bytes))
    assert found[0] == found[1]


def test_a_mode_switch_keeps_the_camera(camera):
    """Pictures after a switch would show the cloth as it was before."""
    eye = camera(**ASIDE)
    with Simulation(Scene(FALLING)) as simulation:
        eye.capture(simulation)
        preparation = simulation.engines.preparation('constraint')
        preparation.run()
        simulation.engines.context.make_current()
        simulation.take_over(preparation)
        simulation.advance(0.3)
        live = eye.capture(simulation)
        still = eye.capture(simulation.snapshot(), colliders=simulation.colliders)
        np.testing.assert_array_equal(live.depth, still.depth)


def test_an_attached_camera_moves_with_its_frame(camera):
    """A camera in a hand would stay where the hand was."""
    cloth = snapshot_of(plane_cloth((-0.4, 0.4, 0.0), (0.8, 0.0, 0.0), (0.0, -0.8, 0.0)))
    eye = camera(frame='hand', position=[0.0, 0.0, 0.1], width=32, height=24)
    down = (1.0, 0.0, 0.0, 0.0)
    for height in (0.5, 0.8):
        picture = eye.capture(cloth, frame=Pose((0.0, 0.0, height), down))
        np.testing.assert_allclose(picture.depth[12, 16], height - 0.1, rtol=ROUNDING)
    np.testing.assert_allclose(picture.pose.position, (0.0, 0.0, 0.7))


@pytest.mark.parametrize('wrong, rule', [
    ({'intrinsics': [0.0, 1.0, 1.0, 1.0]}, 'has fx 0: give a focal length above 0'),
    ({'intrinsics': [1.0, 2.0]}, 'needs 4 numbers, got 2'),
    ({'rate': 1e9}, 'from 0.001 to 1000 Hz'),
    ({'width': 1_000_000}, 'from 1 to 4096 pixel'),
    ({'height': 0}, 'from 1 to 4096 pixel'),
    ({'field_of_view': 180.0}, 'from 1 to 170 deg'),
    ({'near': 3.0, 'far': 2.0}, 'must be below'),
    ({'far': float('nan')}, 'must be finite'),
    ({'target': [1.5, 0.3, 1.2]}, 'is where the camera is'),
    ({'target': []}, 'looks nowhere: give'),
    ({'orientation': [0.0, 0.0, 0.0, 1.0]}, 'give one of them'),
    ({'orientation': [0.0, 0.0, 0.0, 0.0], 'target': []}, 'has no direction'),
    ({'frame': 'tool0'}, 'is a point of the world'),
    ({'zoom': 2.0}, 'a camera has no zoom: give one of width'),
])
def test_wrong_values_are_refused(wrong, rule):
    """The picture would be empty, and nobody told why."""
    with pytest.raises(ClothSimError, match=rule) as refused:
        Camera(**{**ASIDE, **wrong})
    assert '\n' not in str(refused.value)


def test_a_chain_has_no_surface(camera, fallen):
    """The picture of a chain would be empty, and nobody told why."""
    eye = camera(**ASIDE)
    with pytest.raises(ClothSimError, match='chain of 1 x 5 nodes'):
        eye.capture(snapshot_of(np.zeros((1, 5, 3))))
    with pytest.raises(ClothSimError, match='a Simulation or a Snapshot, got 3'):
        eye.capture(3)
