# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw a frame into an image, and the panels that a picture or a video is made of."""

import sys
import warnings

from cloth_sim_ros.analysis.recording import Recording
from cloth_sim_ros.gl.program import RenderProgram
from cloth_sim_ros.rendering import look
from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.look import GRASP_COLOR
from cloth_sim_ros.rendering.look import LIMIT_COLOR
from cloth_sim_ros.rendering.look import PIN_COLOR
from cloth_sim_ros.rendering.look import PUSH_COLOR
from cloth_sim_ros.rendering.look import StrainRange
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.look import UNKNOWN_COLOR
from cloth_sim_ros.rendering.renderer import labels_of
from cloth_sim_ros.rendering.renderer import note_of
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.renderer import title_of
from cloth_sim_ros.rendering.source import RecordingSource
from cloth_sim_ros.rendering.source import StateSource
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import FLAG_AT_LIMIT
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
from cloth_sim_ros.sim.snapshot import FLAG_PINNED
from cut_scene import CUT
from cut_scene import cut_frame
import numpy as np
import pytest

FULL = 0.05
ABOVE = Camera(-90.0, 90.0, 0.0)
BELOW = Camera(-90.0, -90.0, 0.0)


def has_color(image):
    """Tell which pixels are no grey: floor, shadow and background are."""
    return np.ptp(image, axis=-1) > 25


def is_like(image, color):
    """Tell which pixels have the hue of ``color``, 0 to 1, in whatever light."""
    color = np.asarray(color, float)
    direction = color - color.mean()
    spread = image - image.mean(axis=-1, keepdims=True)
    size = np.linalg.norm(spread, axis=-1)
    cosine = spread @ direction / np.maximum(size * np.linalg.norm(direction), 1e-9)
    return (size > 60.0) & (cosine > 0.96)


def pixel_at(image, renderer, point):
    """Return the pixel that shows ``point`` [m]."""
    across, down = renderer.view.project(np.array(point, float))
    return image[int(down), int(across)]


def level(facing, is_front=True):
    """Return how bright a surface is and its gloss, by the cosine that faces the camera: 1."""
    diffuse = (0.5 + 0.5 * look.DIRECTION[2] * facing) ** look.WRAP_POWER
    halfway = look.DIRECTION + (0.0, 0.0, 1.0)
    gloss = look.GLOSS * (halfway[2] / np.linalg.norm(halfway)) ** look.GLOSS_POWER
    return (look.AMBIENT + (1.0 - look.AMBIENT) * diffuse) * (
        1.0 if is_front else look.BACK), gloss


def scale_color(strain):
    """Return the colour of ``strain`` on the scale, without light."""
    return StrainScale(StrainRange(), FULL).colors(np.array([strain]))[0, :3]


@pytest.mark.parametrize('detail', [1, 2])
def test_flat_cloth_pixel_coverage(flat, rendered, detail):
    """The cloth would be shifted, stretched, mirrored or cut off."""
    image, renderer = rendered(flat(), detail=detail)
    (left, top), (right, bottom) = renderer.view.project(
        np.array([[-0.5, 0.5, 0.0], [0.5, -0.5, 0.0]]))
    down, across = np.mgrid[:120, :160] + 0.5
    inside = np.minimum.reduce([across - left, right - across, down - top, bottom - down])
    covered = has_color(image)
    assert covered[inside > 1.0].all()
    assert not covered[inside < -1.0].any()


def test_perspective_covers_what_the_projection_says(flat, rendered):
    """The shader's camera would be another than the one that places words and arrows."""
    image, renderer = rendered(flat(), Camera(20.0, 35.0, 60.0))
    corners = np.array([[-0.5, 0.5, 0.0], [-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0]])
    seen = renderer.view.project(corners)
    pixels = np.stack(np.meshgrid(np.arange(160), np.arange(120)), axis=-1) + 0.5
    sides = np.roll(seen, -1, axis=0) - seen
    away = [
        ((pixels - corner) @ (-side[1], side[0])) / np.linalg.norm(side)
        for corner, side in zip(seen, sides)]
    inside = np.maximum(np.min(away, axis=0), np.min(np.negative(away), axis=0))
    covered = has_color(image)
    assert covered[inside > 1.5].all()
    assert not covered[inside < -1.5].any()


@pytest.mark.parametrize('strain', [0.0, 0.012, 0.031, 0.049, 0.4])
@pytest.mark.parametrize(('camera', 'is_front'), [(ABOVE, True), (BELOW, False)])
def test_the_colour_is_that_of_the_strain_under_the_lamp(
        flat, rendered, strain, camera, is_front):
    """The colour bar would tell another strain, or one side of the cloth be black."""
    image, renderer = rendered(flat(strain=strain), camera)
    bright, gloss = level(1.0, is_front)
    expected = 255.0 * np.minimum(scale_color(strain) * bright + gloss, 1.0)
    np.testing.assert_allclose(
        pixel_at(image, renderer, (0.02, 0.03, 0.0)), expected, atol=1.5)


def test_a_slope_away_from_the_lamp_is_darker(flat, rendered):
    """Folds could not be seen."""
    levels = []
    for tilt in (-0.6, 0.0, 0.6):
        frame = flat(strain=0.0)
        frame.records['normal_x'] = np.sin(tilt)
        frame.records['normal_z'] = np.cos(tilt)
        image, renderer = rendered(frame)
        levels.append(pixel_at(image, renderer, (0.02, 0.03, 0.0)).sum())
    # The lamp stands to the left.
    assert levels[0] > 1.03 * levels[1] > 1.03 * 1.1 * levels[2]


@pytest.mark.parametrize(('camera', 'strain'), [(ABOVE, 0.05), (BELOW, 0.0)])
def test_the_nearer_layer_hides_the_farther_one(flat, rendered, camera, strain):
    """The back of a folded cloth would be drawn over its front."""
    frame = flat(rows=4)
    frame.records['y'] = np.array([-0.5, 0.5, 0.5, -0.5])[:, None]
    frame.records['z'] = np.array([0.0, 0.0, 0.4, 0.4])[:, None]
    frame.records['strain'] = np.array([0.0, 0.0, 0.05, 0.05])[:, None]
    frame.records['normal_z'] = np.array([-1.0, -1.0, 1.0, 1.0])[:, None]
    image, renderer = rendered(frame, camera)
    pixel = pixel_at(image, renderer, (0.02, 0.03, 0.2))
    color = scale_color(strain)
    np.testing.assert_allclose(pixel / pixel.sum(), color / color.sum(), atol=0.04)


def test_edges_are_smooth(flat, rendered):
    """A slanted edge would be a staircase."""
    image, renderer = rendered(flat(strain=0.03), Camera(-70.0, 90.0, 0.0))
    cloth = pixel_at(image, renderer, (0.02, 0.03, 0.0))
    ratio = (255.0 - image[..., 2]) / (255.0 - cloth[2])
    between = (ratio > 0.25) & (ratio < 0.75) & ~np.isclose(ratio, 0.75)
    # A pixel or so in each line along the two edges that it crosses.
    assert 100 < between.sum() < 800


def test_the_same_frame_gives_the_same_image(hanging, rendered):
    """A picture could not be made again, and a video would flicker."""
    frame = hanging()
    first, renderer = rendered(frame, Camera())
    np.testing.assert_array_equal(renderer.draw(frame), first)
    np.testing.assert_array_equal(rendered(frame, Camera())[0], first)


def test_a_frame_after_a_larger_one_is_drawn_alike(flat, rendered):
    """What a larger cloth left on the device would show in the next panel."""
    image, renderer = rendered(flat())
    renderer.draw(flat(rows=30, cols=30))
    np.testing.assert_array_equal(renderer.draw(flat()), image)


@pytest.mark.parametrize(('flags', 'color', 'other'), [
    (FLAG_PINNED, PIN_COLOR, GRASP_COLOR), (FLAG_PINNED | FLAG_GRASPED, GRASP_COLOR, PIN_COLOR)])
def test_pins_are_balls_at_their_nodes(flat, rendered, flags, color, other):
    """A reader would not see what holds the cloth, or see it elsewhere, or take it for another."""
    frame = flat(strain=0.0)
    frame.records['flags'][4, 6] = flags
    image, renderer = rendered(frame, width=400, height=300)
    balls = np.argwhere(is_like(image, color))
    across, down = renderer.view.project(frame.positions[4, 6])
    np.testing.assert_allclose(balls.mean(axis=0) + 0.5, [down, across], atol=0.7)
    # It does not cover the cloth.
    assert 20 < len(balls) < 80
    assert not np.any(is_like(image, other))


def test_a_pin_behind_the_cloth_is_faint(flat, rendered):
    """A pin on the other side would seem to hold this one."""
    frame = flat(rows=4, strain=0.0)
    frame.records['y'] = np.array([-0.5, 0.5, 0.5, -0.5])[:, None]
    frame.records['z'] = np.array([0.0, 0.0, 0.4, 0.4])[:, None]
    frame.records['flags'][0, 3] = FLAG_PINNED
    hidden = {}
    for camera in (ABOVE, BELOW):
        image, renderer = rendered(frame, camera, 400, 300)
        # A little into the cloth, since the node is at its border.
        pixel = pixel_at(image, renderer, frame.positions[0, 3] + (0.0, 0.003, 0.0))
        hidden[camera] = pixel[0] - pixel[1]
    assert hidden[BELOW] > 100
    assert 10 < hidden[ABOVE] < 70


def test_nodes_at_their_limit_have_a_dot(flat, rendered):
    """Active constraints would not be seen, or hide the colour between them."""
    frame = flat(strain=0.05)
    frame.records['flags'][4, 2] = FLAG_AT_LIMIT
    image, renderer = rendered(frame)
    node, next_node = frame.positions[4, 2], frame.positions[4, 3]
    np.testing.assert_allclose(
        pixel_at(image, renderer, node), 255.0 * np.array(LIMIT_COLOR), atol=3.0)
    bare = rendered(flat(strain=0.05))[0]
    changed = np.argwhere((image != bare).any(axis=-1)) + 0.5
    radius = 0.36 * np.linalg.norm(next_node - node) / renderer.view.pixel + 1.0
    away = changed[:, ::-1] - renderer.view.project(node)
    assert np.linalg.norm(away, axis=1).max() < radius


def test_a_push_is_an_arrow_along_its_force(flat, rendered):
    """A reader would not see what moves the cloth, nor where to."""
    push = Push.checked(force=(2.0, 0.0, 0.0), start=0.0, duration=9.0)
    frame = flat(pushes=(push,), strain=0.0)
    image, renderer = rendered(frame)
    blue = np.argwhere(is_like(image, PUSH_COLOR)) + 0.5
    tail, tip = renderer.view.project(np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]]))
    assert blue[:, 1].min() == pytest.approx(tail[0], abs=2.0)
    assert blue[:, 1].max() == pytest.approx(tip[0], abs=3.0)
    assert np.abs(blue[:, 0] - tail[1]).max() < 5.0
    # It is thicker at its head.
    head = blue[blue[:, 1] > 0.25 * tail[0] + 0.75 * tip[0]]
    shaft = blue[blue[:, 1] < 0.5 * (tail[0] + tip[0])]
    assert np.ptp(head[:, 0]) > np.ptp(shaft[:, 0])


def test_a_push_on_a_region_has_a_ring(flat, rendered):
    """A reader would take it for a push on the whole cloth."""
    push = Push.checked(
        force=(0.0, 0.0, 2.0), start=0.0, duration=9.0, region='sphere', center=(0.1, 0.0, 0.1),
        radius=0.3)
    image, renderer = rendered(flat(pushes=(push,), strain=0.0))
    for angle in np.arange(0.0, 6.0, 0.5):
        point = np.array(push.center) + 0.3 * np.array([np.cos(angle), np.sin(angle), 0.0])
        across, down = renderer.view.project(point).astype(int)
        near = image[down - 1:down + 2, across - 1:across + 2]
        assert (near[..., 2] - near[..., 0]).max() > 90, angle


@pytest.mark.parametrize('radius', [1e6, 1e300, sys.float_info.max])
def test_a_push_on_a_huge_region_is_an_arrow(flat, rendered, radius):
    """A recording with such a push could not be drawn, or with warnings only."""
    # As a recording of another program may have it: today's node refuses more than 1e6 m.
    push = Push((0.0, 0.0, 2.0), start=0.0, duration=9.0, region='sphere', radius=radius)
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        image = rendered(flat(pushes=(push,), strain=0.0))[0]
    assert is_like(image, PUSH_COLOR).any()


@pytest.mark.parametrize('shape', [(30, 1), (1, 30)])
def test_a_chain_is_a_line(flat, rendered, shape):
    """A cloth of one column has no faces, and would not be seen."""
    frame = flat(*shape)
    if shape[1] == 1:
        frame.records['x'] = 0.0
    else:
        frame.records['y'] = 0.0
    image, renderer = rendered(frame)
    middles = (frame.positions.reshape(-1, 3)[1:] + frame.positions.reshape(-1, 3)[:-1]) / 2.0
    for point in middles:
        np.testing.assert_allclose(
            pixel_at(image, renderer, point), 255.0 * scale_color(0.03), atol=90.0)
    assert 100 < has_color(image).sum() < 800


def test_nodes_of_a_chain_at_their_limit_have_a_ball(flat, rendered):
    """A chain has no surface for dots."""
    frame = flat(1, 30, strain=0.0)
    frame.records['y'] = 0.0
    frame.records['flags'][0, 10] = FLAG_AT_LIMIT
    image, renderer = rendered(frame, width=400, height=300)
    found = np.argwhere(is_like(image, LIMIT_COLOR)) + 0.5
    across, down = renderer.view.project(frame.positions[0, 10])
    np.testing.assert_allclose(found.mean(axis=0), [down, across], atol=1.0)


def test_a_cloth_of_unknown_strain_has_one_plain_colour(flat, rendered):
    """A state without strain would be drawn as if it had none."""
    image, renderer = rendered(flat(strain=np.nan))
    bright, gloss = level(1.0)
    np.testing.assert_allclose(
        pixel_at(image, renderer, (0.02, 0.03, 0.0)),
        255.0 * (np.array(UNKNOWN_COLOR) * bright + gloss), atol=1.5)


def test_the_grid_lies_at_round_places(flat, rendered):
    """Lengths could not be read off the floor."""
    frame = flat(strain=0.0)
    frame.records['x'] = 0.4 * frame.records['x'] + 3.0
    # Without perspective and from above, the floor below is where it is.
    image, renderer = rendered(frame, width=400, height=300)
    line = pixel_at(image, renderer, (3.4, 0.2, 0.0))
    beside = pixel_at(image, renderer, (3.33, 0.27, 0.0))
    assert line.max() < 240 and beside.min() == 255


def test_far_from_the_origin_the_cloth_keeps_its_shape(flat, rendered):
    """Single precision would tear a cloth that hangs a kilometre away."""
    near, far = flat(), flat()
    # A multiple of the grid, so that the floor is the same; float32 has 2^-11 there, so a shift
    # of a power of two keeps the shape exactly.
    for axis in 'xy':
        near.records[axis] = np.round(near.records[axis] * 1024) / 1024
        far.records[axis] = near.records[axis] + 4096.0
    first, second = rendered(near)[0], rendered(far)[0]
    covered = has_color(first)
    np.testing.assert_array_equal(covered, has_color(second))
    np.testing.assert_allclose(first[covered], second[covered], atol=12)


def test_hundreds_of_thousands_of_nodes_are_drawn(rendered, flat):
    """A fine cloth would take minutes, or run out of some limit."""
    image, renderer = rendered(flat(600, 600))
    assert pixel_at(image, renderer, (0.49, -0.49, 0.0))[2] < 200
    assert has_color(image).sum() > 0.3 * image[..., 0].size


def test_only_what_is_drawn_is_compiled(flat, rendered, monkeypatch):
    """A picture of a plain cloth would wait for shaders that it does not need."""
    compiled = []
    make = RenderProgram.__init__

    def counted(self, vertex, fragment, defines=None):
        compiled.append(vertex)
        make(self, vertex, fragment, defines)

    monkeypatch.setattr(RenderProgram, '__init__', counted)
    rendered(flat())
    assert sorted(compiled) == ['render/cloth.vert', 'render/cloth.vert', 'render/floor.vert']


# What a picture says of its sources.


@pytest.fixture
def sources(known, tmp_path, flat):
    """Return a recording and a state file without strain."""
    np.savez(tmp_path / 'last.npz', positions=flat().positions)
    return [RecordingSource(Recording(known.folder)), StateSource(tmp_path / 'last.npz')]


def test_the_title_tells_size_and_modes(sources, flat):
    """A picture would not show which run it is of."""
    assert title_of(sources[:1], [flat(4, 5)]) == '4 x 5 nodes, mass_spring'
    assert title_of(sources, [flat(4, 5)]) == '4 x 5 nodes'
    assert title_of(sources, [flat(4, 5), flat(6, 5)]) == ''


def test_rows_are_named_by_folder_and_mode_or_as_asked(sources):
    """A reader would not know which row is which."""
    assert labels_of(sources, Style()) == ['known (mass_spring)', 'last']
    assert labels_of(sources, Style(labels=('one', 'two'))) == ['one', 'two']


def test_the_note_tells_what_is_not_drawn(sources):
    """A cloth without pins and strain would be taken for one that has none."""
    assert note_of(sources) == (
        'simulated on a device; last lacks strain and pins and limits: not drawn')
    assert note_of(sources[:1]) == 'simulated on a device'


@pytest.mark.parametrize('look', ['strain', 'plain', 'checked'])
def test_holes_of_a_cut_cloth_are_seen_through(rendered, look):
    """A picture would show a rectangle, or triangles to the origin."""
    scene = Scene(CUT)
    frame = cut_frame(scene)
    z = float(np.nanmax(frame.positions[..., 2]))
    image, renderer = rendered(frame, ABOVE, look=look, width=320, height=320)

    def shade(x, y):
        return pixel_at(image, renderer, (x, y, z))

    cloth, hole, corner = shade(0.0, 0.12), shade(0.0, 0.0), shade(0.17, 0.16)
    # Behind the hole is what lies beside the cloth.
    assert np.abs(cloth - hole).max() > 20.0
    assert np.abs(cloth - corner).max() > 20.0 and np.abs(hole - corner).max() < 60.0
