# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw what is not cloth: floor, ribbons, balls at pins, arrows of pushes, and colliders."""

from dataclasses import replace

from cloth_sim_ros.rendering import look
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.solid_drawing import ball_radius
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.model.pose import unit_quaternion
import numpy as np
import pytest

VIEW = Camera().looking_at(np.eye(3), 600, 450)


def test_few_balls_have_a_fixed_size():
    """Two pins close together would be specks."""
    two = np.array([[10.0, 10.0], [11.0, 10.0]])
    assert ball_radius(two, VIEW) == ball_radius(two[:1], VIEW) == pytest.approx(6.0)


def test_many_balls_leave_room_between_them():
    """The pins of an edge would cover the cloth."""
    row = np.stack([np.arange(50) * 8.0, np.zeros(50)], axis=1)
    assert 2.0 * ball_radius(row, VIEW) < 8.0
    assert ball_radius(0.01 * row, VIEW) > 1.0
    assert ball_radius(10.0 * row, VIEW) == pytest.approx(6.0)


# Colliders cover the pixels that their shape does, and hide what is behind them.

ABOVE = Camera(-90.0, 90.0, 0.0)
# About z by 30 degrees, and about y by 90.
TURNED = unit_quaternion((0.0, 0.0, np.sin(np.pi / 12), np.cos(np.pi / 12)), 'a turn')
LYING = unit_quaternion((0.0, 1.0, 0.0, 1.0), 'a turn')


def body(shape, size, position, orientation=(0.0, 0.0, 0.0, 1.0)):
    """Return a collider."""
    return Collider('body', shape, size, position, orientation, 0.3)


def cloth(flat, nodes=9):
    """Return a cloth that is blue all over."""
    return flat(nodes, nodes, strain=0.0)


def with_body(frame, *colliders):
    """Return ``frame`` with ``colliders``."""
    return replace(frame, colliders=colliders)


def is_body(image):
    """Tell which pixels have the hue of colliders, in whatever light, and not the cloth's."""
    red, green, blue = np.moveaxis(image, -1, 0)
    return (red - blue > 4) & (red - blue < 40) & (red >= green) & (red < 220)


def places(renderer):
    """Return x and y [m] of the middle of each pixel, seen from above, (height, width, 2)."""
    view = renderer.view
    across, down = np.meshgrid(np.arange(view.width) + 0.5, np.arange(view.height) + 0.5)
    return np.stack([
        view.middle[0] + view.pixel * (across - view.width / 2.0),
        view.middle[1] - view.pixel * (down - view.height / 2.0)], axis=-1)


def away_of(shape, x, y):
    """Return how far (x, y) [m] is from the outline of the shape seen from above."""
    if shape == 'sphere':
        return np.hypot(x, y) - 0.2
    if shape == 'cylinder':
        return np.hypot(x, y) - 0.2
    if shape == 'capsule':   # lies along x
        return np.hypot(x - np.clip(x, -0.15, 0.15), y) - 0.1
    along, over = (x * np.cos(np.pi / 6) + y * np.sin(np.pi / 6),
                   y * np.cos(np.pi / 6) - x * np.sin(np.pi / 6))
    outside = np.maximum([np.abs(along) - 0.2, np.abs(over) - 0.1], 0.0)
    return np.hypot(*outside) + np.minimum(
        np.maximum(np.abs(along) - 0.2, np.abs(over) - 0.1), 0.0)


@pytest.mark.parametrize('detail', [1, 2])
@pytest.mark.parametrize(('shape', 'size', 'turn'), [
    ('sphere', (0.2,), TURNED), ('cylinder', (0.2, 0.3), TURNED), ('capsule', (0.1, 0.3), LYING),
    ('box', (0.4, 0.2, 0.3), TURNED)])
def test_a_body_covers_the_pixels_that_its_outline_says(
        flat, rendered, shape, size, turn, detail):
    """It would be shifted, turned the other way, or of another size."""
    frame = with_body(cloth(flat), body(shape, size, (0.15, -0.1, 0.5), turn))
    image, renderer = rendered(frame, detail=detail)
    x, y = np.moveaxis(places(renderer) - (0.15, -0.1), -1, 0)
    away, covered = away_of(shape, x, y), is_body(image)
    assert covered[away < -renderer.view.pixel].all()
    assert not covered[away > renderer.view.pixel].any()


def test_perspective_shows_the_outline_of_a_sphere(flat, rendered):
    """Bodies would be seen by another camera than the cloth."""
    centre, radius = np.array([0.1, 0.2, 0.4]), 0.25
    frame = with_body(cloth(flat), body('sphere', (radius,), tuple(centre)))
    image, renderer = rendered(frame, Camera(20.0, 35.0, 60.0), 320, 240)
    view = renderer.view
    rows, cols = np.indices((240, 320)) + 0.5
    focus = view.distance / view.pixel
    rays = np.stack([
        (cols - 160.0) / focus, (120.0 - rows) / focus, -np.ones_like(rows)], axis=-1) @ view.axes
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    to_centre = centre - (view.middle + view.distance * view.axes[2])
    distance = np.linalg.norm(np.cross(rays, to_centre), axis=-1)
    covered, pixel = is_body(image), view.pixel
    assert covered[distance < radius - pixel].all()
    assert not covered[distance > radius + pixel].any()


def test_its_colour_is_that_of_its_slope_under_the_lamp(flat, rendered):
    """A body would be flat, or lit from another side than the cloth."""
    frame = with_body(cloth(flat), body('sphere', (0.3,), (0.0, 0.0, 0.5)))
    image, renderer = rendered(frame, width=320, height=240)
    halfway = look.DIRECTION + (0.0, 0.0, 1.0)
    halfway /= np.linalg.norm(halfway)
    for x, y in ((0.0, 0.0), (0.15, 0.0), (-0.1, 0.2), (0.0, -0.2)):
        normal = np.array([x, y, np.sqrt(0.09 - x * x - y * y)]) / 0.3
        diffuse = (0.5 + 0.5 * look.DIRECTION @ normal) ** look.WRAP_POWER
        gloss = look.GLOSS * max(halfway @ normal, 0.0) ** look.GLOSS_POWER
        bright = look.AMBIENT + (1.0 - look.AMBIENT) * diffuse
        across, down = renderer.view.project(np.array([x, y, 0.5]))
        np.testing.assert_allclose(
            image[int(down), int(across)],
            255.0 * (bright * np.array(look.COLLIDER_COLOR) + gloss), atol=4.0)


@pytest.mark.parametrize(('height', 'is_hidden'), [(-0.2, False), (0.2, True)])
def test_the_nearer_of_body_and_cloth_is_seen(flat, rendered, height, is_hidden):
    """A table would be seen through the cloth on it, or a ball in front of it not at all."""
    image, renderer = rendered(
        with_body(cloth(flat), body('sphere', (0.15,), (0.0, 0.0, height))))
    across, down = renderer.view.project(np.array([0.02, 0.03, 0.0]))
    assert is_body(image)[int(down), int(across)] == is_hidden


@pytest.mark.parametrize('camera', [
    ABOVE, Camera(30.0, 25.0), Camera(-80.0, 6.0), Camera(200.0, 50.0, 0.0)])
def test_cloth_that_lies_on_a_body_hides_it(flat, rendered, camera):
    """The body would flicker through a cloth that is half its thickness above."""
    top = body('box', (0.6, 0.6, 0.4), (0.0, 0.0, -0.2005))
    image, renderer = rendered(with_body(cloth(flat, 41), top), camera, 400, 300)
    inside = np.stack(np.meshgrid(*2 * [np.linspace(-0.25, 0.25, 60)], [0.0]), axis=-1)
    pixels = np.floor(renderer.view.project(inside.reshape(-1, 3))).astype(int)
    assert not is_body(image)[pixels[:, 1], pixels[:, 0]].any()


def test_tilted_plane_hides_what_is_below(flat, rendered):
    """A slope would not be seen, or cover the cloth that lies on it."""
    slope = body('plane', (), (0.0, 0.0, -0.05), unit_quaternion((0.0, 0.25, 0.0, 1.0), 'a turn'))
    frame = with_body(cloth(flat), slope)
    image, renderer = rendered(frame)
    for x, is_hidden in ((-0.4, True), (0.4, False)):
        point = np.array([x, 0.03, 0.0])
        across, down = renderer.view.project(point)
        # The slope is above the cloth where its distance is negative.
        assert (slope.distance(point) < 0.0) == is_hidden
        assert is_body(image)[int(down), int(across)] == is_hidden
    # From below, where no cloth can be, it hides nothing.
    image, _ = rendered(frame, Camera(-90.0, -90.0, 0.0))
    assert not is_body(image).any()


def test_a_level_plane_is_the_floor(flat, rendered):
    """The grid would not be where the cloth lies, or what is below the floor be seen."""
    plane = body('plane', (), (0.0, 0.0, -1.0))
    ball = replace(body('sphere', (0.2,), (0.0, 0.0, -1.05)), name='ball')
    camera = Camera(-90.0, 30.0, 0.0, target=(0.0, 0.0, -1.0))
    image, renderer = rendered(with_body(cloth(flat), plane, ball), camera, 600, 450)

    def pixel(point):
        across, down = renderer.view.project(np.array(point))
        return image[int(down), int(across)]

    # Lines are 0.2 m apart.
    assert pixel((0.2, -0.67, -1.0)).max() < pixel((0.27, -0.67, -1.0)).min() - 10
    np.testing.assert_allclose(
        pixel((0.27, -0.67, -1.0)), 255.0 * np.array(look.GROUND_COLOR), atol=4)
    covered = is_body(image)
    shown, hidden = (renderer.view.project(np.array(point)).astype(int) for point in (
        (0.0, -0.15, -0.94), (0.0, -0.13, -1.17)))
    assert covered[shown[1], shown[0]] and not covered[hidden[1], hidden[0]]


def test_a_body_has_a_shadow_on_the_floor(flat, rendered):
    """It would seem to float, or to stand elsewhere."""
    frame = with_body(cloth(flat), body('box', (0.2, 0.2, 0.2), (0.9, 0.0, 0.3)))
    image, renderer = rendered(frame, Camera(-90.0, 40.0, 0.0), 600, 450)
    across, down = renderer.view.project(np.array([0.93, 0.03, -0.03])).astype(int)
    np.testing.assert_allclose(image[down, across], 255.0 * np.array(look.SHADOW_COLOR), atol=3)


def test_without_colliders_nothing_of_it_is_drawn(flat, rendered):
    """Pictures of other scenes would change."""
    image, _ = rendered(cloth(flat))
    np.testing.assert_array_equal(image, rendered(with_body(cloth(flat)))[0])
    assert not is_body(image).any()
