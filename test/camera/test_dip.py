# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cloth that lies on a body is seen on it, and behind the body it is hidden, by formula."""

from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.look import Look
import numpy as np
import pytest
from seen_by_formula import meet_sphere
from seen_by_formula import meet_triangles
from seen_by_formula import rays_of
from seen_by_formula import triangles_of
from seen_cloths import plane_cloth
from seen_cloths import snapshot_of

UNTURNED = (0.0, 0.0, 0.0, 1.0)
RADIUS = 0.1
THICKNESS = 1e-3  # of a snapshot [m]
BALL = Collider('ball', 'sphere', (RADIUS,), (0.0, 0.0, 0.0), UNTURNED, 0.3)
BOX = Collider('box', 'box', (0.3, 0.2, 0.2), (0.0, 0.0, 0.0), UNTURNED, 0.3)
# Elevations of the camera [deg]: faces are seen from their front, and along the surface.
ELEVATIONS = (80.0, 30.0, 0.0)


def dome():
    """Return a coarse cloth whose nodes touch the upper half of the ball, (9, 9, 3)."""
    x, y = np.meshgrid(np.linspace(-1.1, 1.1, 9), np.linspace(1.1, -1.1, 9))
    angle = np.hypot(x, y)
    share = np.sin(angle) / np.maximum(angle, 1e-9)
    unit = np.stack([share * x, share * y, np.cos(angle)], axis=-1)
    return ((RADIUS + THICKNESS / 2.0) * unit).astype(np.float32).astype(float)


def around(elevation):
    """Return the parameters of a camera that looks at the origin from an elevation [deg]."""
    angle = np.radians(elevation)
    return {
        'position': [0.1, -0.6 * float(np.cos(angle)), 0.6 * float(np.sin(angle))],
        'target': [0.0, 0.0, 0.0], 'width': 160, 'height': 120, 'field_of_view': 30.0}


def met(picture, cloth):
    """Return the depth of the faces of ``cloth``, (height, width) float64 [m]; inf for none."""
    eye = picture.camera
    triangles = triangles_of(picture.pose.seen_from(cloth))
    return meet_triangles(rays_of(eye), triangles).reshape(eye.height, eye.width)


def place_of(picture, depth):
    """Return where ``depth`` is in the world, (height, width, 3) [m]."""
    rays = rays_of(picture.camera).reshape(*depth.shape, 3)
    return picture.pose.in_world(np.where(np.isfinite(depth), depth, np.nan)[..., None] * rays)


@pytest.mark.parametrize('elevation', ELEVATIONS)
def test_faces_that_dip_into_a_ball_are_seen(camera, elevation):
    """Specks of the ball would be seen in the cloth that covers it, most along the surface."""
    cloth = dome()
    picture = camera(**around(elevation)).capture(snapshot_of(cloth), colliders=[BALL])
    depth = met(picture, cloth)
    height = BALL.distance(place_of(picture, depth))
    inside = np.nan_to_num(height, nan=1.0) < -1e-6
    assert inside.sum() > 100
    # How deep a chord over the longest diagonal is inside, which is the dip without a margin.
    step = np.linalg.norm(cloth[1:, 1:] - cloth[:-1, :-1], axis=-1).max()
    assert -height[inside].min() < RADIUS - np.sqrt(RADIUS ** 2 - step ** 2 / 4.0)
    middle = picture.pose.seen_from(np.zeros(3))
    entry = meet_sphere(rays_of(picture.camera), middle, RADIUS).reshape(depth.shape)
    # Only a ray that stays within the dip reaches the far side: of faces there, not all.
    near = inside & (depth < middle[2])
    assert near.sum() > 100 and (entry[near] < depth[near]).all()
    assert (picture.labels[near] == 1).all()
    np.testing.assert_allclose(picture.depth[near], depth[near], rtol=1e-5)
    # What the cloth leaves bare has the depth of the ball to the rounding.
    bare = np.isinf(depth) & (picture.labels == 2)
    np.testing.assert_allclose(picture.depth[bare], entry[bare], rtol=3e-6)


@pytest.mark.parametrize('elevation', ELEVATIONS)
def test_colours_show_the_faces_that_dip(camera, elevation):
    """Labels would be of the cloth where the colours are those of the ball."""
    look = Look(color=(1.0, 0.0, 0.0), back_color=(1.0, 0.0, 0.0),
                bodies={'ball': (0.0, 1.0, 0.0)}, background=(0.0, 0.0, 1.0))
    for samples in (1, 4):
        picture = camera(**around(elevation), samples=samples).capture(
            snapshot_of(dome()), colliders=[BALL], look=look)
        seen = np.array([3, 1, 2])[picture.labels]
        inner = np.ones(seen.shape, bool)
        for shift in ((0, 1), (1, 0), (0, -1), (-1, 0)):
            inner &= np.roll(seen, shift, (0, 1)) == seen
        wrong = (picture.color.argmax(axis=-1) + 1 != seen) & inner
        assert (seen[inner] == 1).sum() > 500 and wrong.sum() <= 2, samples


def test_a_box_hides_the_cloth_behind_it(camera):
    """Cloth that hangs down behind a box would be seen through its edge."""
    back = BOX.size[1] / 2.0 + THICKNESS / 2.0
    cloth = plane_cloth((-0.25, back, 0.15), (0.5, 0.0, 0.0), (0.0, 0.0, -0.3), 7, 11)
    for elevation in (10.0, 40.0):
        picture = camera(**around(elevation)).capture(snapshot_of(cloth), colliders=[BOX])
        alone = camera(**around(elevation)).capture(
            snapshot_of(cloth + (0.0, 0.0, -50.0)), colliders=[BOX])
        hidden = (alone.labels == 2) & np.isfinite(met(picture, cloth))
        assert hidden.sum() > 200
        np.testing.assert_array_equal(picture.labels[hidden], 2)
        np.testing.assert_array_equal(picture.depth[hidden], alone.depth[hidden])


def test_a_bent_cloth_covers_the_edge_of_a_box(camera):
    """The edge of a table would be seen through the tablecloth, between two rows of nodes."""
    # The edge is half-way between two rows that touch the box on either side of it.
    way = np.linspace(0.1625, -0.1625, 14)[:, None]
    over = (BOX.size[1] + THICKNESS) / 2.0
    x = np.linspace(-0.2, 0.2, 17)
    cloth = np.stack(np.broadcast_arrays(
        x, np.maximum(way, 0.0) - over, over + np.minimum(way, 0.0)), axis=-1)
    picture = camera(**around(35.0)).capture(snapshot_of(cloth), colliders=[BOX])
    depth = met(picture, cloth)
    inside = np.nan_to_num(BOX.distance(place_of(picture, depth)), nan=1.0) < -1e-4
    assert inside.sum() > 50
    assert (picture.labels[inside] == 1).all()


@pytest.mark.parametrize('deep', [0.02, 0.04])
def test_cloth_deep_inside_of_a_ball_is_hidden(camera, deep):
    """Cloth that has passed through a body would look as if it lay on it."""
    height = RADIUS - deep
    cloth = plane_cloth((-0.02, 0.02, height), (0.04, 0.0, 0.0), (0.0, -0.04, 0.0), 5, 5)
    picture = camera(**around(60.0)).capture(snapshot_of(cloth), colliders=[BALL])
    assert (picture.labels == 2).sum() > 500 and not (picture.labels == 1).any()
