# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Draw a frame as one sees it: a fabric on its bodies and floor in daylight, with shadows."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.daylight import BODY_COLOR
from cloth_sim_ros.rendering.daylight import CHECK_COLOR
from cloth_sim_ros.rendering.daylight import KNIT_COLOR
from cloth_sim_ros.rendering.daylight import LOOKS
from cloth_sim_ros.rendering.daylight import PLAIN_COLOR
from cloth_sim_ros.rendering.daylight import TWILL_COLOR
from cloth_sim_ros.rendering.daylight import WARP_COLOR
from cloth_sim_ros.rendering.look import StrainRange
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.renderer import has_bar
from cloth_sim_ros.rendering.renderer import Style
from cloth_sim_ros.rendering.sheet import legend_handles
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.model.colliders import Collider
import numpy as np
import pytest

ABOVE = Camera(-90.0, 90.0, 0.0)
SIDE = Camera(-90.0, 30.0, 0.0)


def hue(color):
    """Return the direction of a colour apart from its grey."""
    spread = np.asarray(color, float) - np.mean(color, axis=-1, keepdims=True)
    return spread / np.maximum(np.linalg.norm(spread, axis=-1, keepdims=True), 1e-9)


def has_hue(image, color):
    """Tell which pixels have the hue of ``color``, 0 to 1, in whatever light."""
    return (np.ptp(image, axis=-1) > 15) & (hue(image) @ hue(color) > 0.95)


def floor_levels(image):
    """Return the brightness of the pixels that are grey, 0 to 255."""
    return image[np.ptp(image, axis=-1) < 12].mean(axis=-1)


@pytest.mark.parametrize(('look', 'color'), [
    ('fabric', WARP_COLOR), ('twill', TWILL_COLOR), ('knit', KNIT_COLOR), ('plain', PLAIN_COLOR),
    ('checked', CHECK_COLOR)])
def test_a_fabric_has_its_colour_and_not_its_strain(flat, rendered, look, color):
    """A reader would take the fabric for a strain."""
    image, _ = rendered(flat(strain=0.05), ABOVE, look=look)
    relaxed, _ = rendered(flat(strain=0.0), ABOVE, look=look)
    np.testing.assert_array_equal(image, relaxed)
    assert has_hue(image, color).mean() > 0.1


@pytest.mark.parametrize('cols', [9, 33])
def test_checks_are_squares_whatever_the_grid(flat, rendered, cols):
    """A fine cloth would be woven of other threads than a coarse one."""
    image, renderer = rendered(flat(cols=cols), ABOVE, width=400, height=300, look='checked')
    middle = renderer.view.project(np.array([[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]))
    (left, down), (right, _) = middle.round().astype(int)
    # Along the middle of a row of checks, from one side to the other.
    size = (right - left) / 20.0
    line = image[int(down + size / 2.0), left + 2:right - 2, 1]
    # Twenty checks, every second one darker.
    changes = np.diff((line > line.mean()).astype(int))
    assert 18 <= np.count_nonzero(changes) <= 20


@pytest.mark.parametrize('look', ['fabric', 'twill', 'knit'])
def test_threads_are_seen_near_and_run_together_from_afar(flat, rendered, look):
    """A woven cloth would look like cardboard, or flicker where threads are below a pixel."""
    spread = []
    for zoom in (8.0, 0.25):
        image, renderer = rendered(
            flat(), Camera(-90.0, 90.0, 0.0, zoom), width=320, height=240, look=look)
        (across, down), = renderer.view.project(np.zeros((1, 3))).round().astype(int)
        part = image[down - 12:down + 12, across - 12:across + 12].sum(axis=-1)
        spread.append(part.std() / part.mean())
    assert spread[0] > 0.1 > 0.05 > spread[1]


def test_the_cloth_casts_a_shadow_on_the_floor(flat, rendered):
    """A draped cloth would float."""
    frame = flat(rows=5, cols=5)
    frame.records['x'] *= 0.3
    frame.records['y'] *= 0.3
    frame.records['z'] = 0.1
    floor = Collider('floor', 'plane', (), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 0.5)
    camera = Camera(-90.0, 50.0, 0.0, zoom=0.4)
    image, _ = rendered(_with(frame, floor), camera, width=320, height=240, look='plain')
    levels = floor_levels(image)
    # Less than the cloth covers of the picture, of which the shadow is partly behind it.
    assert 0.01 < np.mean(levels < 0.85 * np.median(levels)) < 0.2


@pytest.mark.parametrize('look', ['plain', 'strain'])
def test_a_floor_hides_nothing_from_below(flat, rendered, look):
    """Nobody would see how the lower layer of a folded towel lies."""
    frame = flat(rows=5, cols=5, strain=0.05)
    floor = Collider('floor', 'plane', (), (0.0, 0.0, -0.01), (0.0, 0.0, 0.0, 1.0), 0.5)
    camera = Camera(-90.0, -40.0, 0.0)
    seen, without = (
        np.ptp(rendered(each, camera, look=look)[0], axis=-1) > 25
        for each in (_with(frame, floor), frame))
    assert without.mean() > 0.1
    np.testing.assert_array_equal(seen, without)


def test_a_body_below_the_cloth_is_drawn(flat, rendered):
    """What the cloth lies on would not be seen."""
    frame = flat(rows=5, cols=5)
    frame.records['x'] *= 0.6
    frame.records['y'] *= 0.6
    frame.records['z'] = 0.3
    ball = Collider('ball', 'sphere', (0.1,), (0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0), 0.5)
    image, renderer = rendered(_with(frame, ball), SIDE, width=320, height=240, look='plain')
    across, down = renderer.view.project(np.array((0.0, -0.08, 0.14)))
    assert has_hue(image, BODY_COLOR)[int(down), int(across)]


@pytest.mark.parametrize(('above', 'is_seen'), [(0.004, False), (0.02, True)])
def test_a_body_in_a_face_is_hidden_by_it(flat, rendered, above, is_seen):
    """Spots of a table would show in a cloth whose faces dip into its rim, or a finger vanish."""
    table = Collider(
        'table', 'box', (0.4, 0.4, 0.2), (0.0, 0.0, above - 0.1), (0.0, 0.0, 0.0, 1.0), 0.5)
    image, renderer = rendered(_with(flat(), table), ABOVE, look='plain')
    across, down = renderer.view.project(np.array((0.03, 0.02, above)))
    assert has_hue(image, BODY_COLOR)[int(down), int(across)] == is_seen


def test_the_far_side_of_a_fold_is_darker(flat, rendered):
    """Folds could not be seen."""
    levels = []
    for tilt in (-0.6, 0.0, 0.6):
        frame = flat(strain=0.0)
        frame.records['normal_x'] = np.sin(tilt)
        frame.records['normal_z'] = np.cos(tilt)
        image, renderer = rendered(frame, ABOVE, look='plain')
        across, down = renderer.view.project(np.array((0.02, 0.03, 0.0)))
        levels.append(image[int(down), int(across)].sum())
    # The lamp stands to the left.
    assert levels[0] > levels[1] > levels[2]


@pytest.mark.parametrize('look', LOOKS)
def test_the_same_frame_gives_the_same_image(hanging, rendered, look):
    """A picture could not be made again, and a video would flicker."""
    frame = hanging()
    first, renderer = rendered(frame, Camera(), look=look)
    np.testing.assert_array_equal(renderer.draw(frame), first)


@pytest.mark.parametrize('look', LOOKS)
def test_a_chain_is_drawn_in_every_look(flat, rendered, look):
    """A chain has no surface: drawing it would fail, or show nothing."""
    image, _ = rendered(flat(rows=9, cols=1), SIDE, look=look)
    assert (np.ptp(image, axis=-1) > 10).any()


def test_only_strain_has_a_bar_and_a_grid(hanging):
    """A fabric would be explained by a scale that it does not follow."""
    strains = StrainRange()
    strains.add(np.array([0.01]))
    scale = StrainScale(strains)
    assert has_bar(scale, Style()) and not has_bar(scale, Style(look='plain'))
    ball = Collider('ball', 'sphere', (0.1,), (0.0, 0.0, 0.1), (0.0, 0.0, 0.0, 1.0), 0.5)
    survey = Survey()
    survey.add(_with(hanging(), ball))
    view = SIDE.looking_at(survey.points, 320, 240)
    handles = legend_handles(survey, view, 0.1, 5.0, 'plain')
    assert [handle.get_label() for handle in handles] == ['pinned']


def _with(frame, *colliders):
    return type(frame)(frame.time, frame.records, frame.pushes, colliders=colliders)
