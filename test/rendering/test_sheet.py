# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compose images, headings and a legend to a sheet: where its parts are, and what they show."""

from dataclasses import replace

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.rendering.sheet import Layout
from cloth_sim_ros.rendering.sheet import legend_handles
from cloth_sim_ros.rendering.sheet import panel_size
from cloth_sim_ros.rendering.sheet import Sheet
from cloth_sim_ros.rendering.survey import Survey
from cloth_sim_ros.sim.model.colliders import Collider
from cloth_sim_ros.sim.snapshot import FLAG_GRASPED
import numpy as np
import pytest

FRONT = Camera(-90.0, 0.0)
LAYOUTS = [
    Layout(1, 1, (320, 240)), Layout(2, 3, (301, 207), has_labels=True),
    Layout(3, 2, (100, 400), has_title=False, has_bar=False), Layout(1, 5, (64, 64))]


@pytest.mark.parametrize(('wide', 'high', 'ratio'), [
    (1.0, 1.0, 1.0), (1.2, 1.0, 1.2), (1.0, 1.5, 1 / 1.5), (1.0, 0.0, 1.7), (0.0, 1.0, 1 / 1.7)])
def test_it_has_the_shape_of_the_scene(wide, high, ratio):
    """A panel would be half empty, or a finger wide."""
    corners = np.array([[0.0, 0.0, 0.0], [wide, 5.0, high]])
    width, height = panel_size(corners, FRONT)
    assert width / height == pytest.approx(ratio, rel=0.02)
    assert 300 < width < 700


@pytest.mark.parametrize('layout', LAYOUTS)
def test_panels_are_beside_each_other_within_the_sheet(layout):
    """A panel would cover another one, or be cut off."""
    width, height = layout.size
    taken = set()
    for number in range(layout.rows * layout.columns):
        left, top = layout.corner(number)
        right, bottom = left + layout.panel[0], top + layout.heading + layout.panel[1]
        assert left >= layout.left and top >= layout.top
        assert right <= layout.bar_left and bottom <= height - layout.legend_height
        for x in (left, right - 1):
            for y in (top, bottom - 1):
                assert (x, y) not in taken
                taken.add((x, y))
    assert layout.bar_left + layout.bar_width <= width


@pytest.mark.parametrize('layout', LAYOUTS)
def test_sheets_have_even_sides(layout):
    """H.264 takes no others."""
    assert layout.size[0] % 2 == 0 and layout.size[1] % 2 == 0


@pytest.mark.parametrize('parts', [
    {'rows': 1, 'columns': 1}, {'rows': 1, 'columns': 2, 'has_title': False},
    {'rows': 2, 'columns': 3, 'has_bar': False}])
def test_a_sheet_of_a_given_size_can_be_asked_for(parts):
    """A video would not have the size of a screen."""
    width, height = Layout.within(1280, 720, **parts).size
    assert abs(width - 1280) <= 4 and abs(height - 720) <= 4


# What is around the panels, and where they go.


@pytest.fixture
def sheet_of(hanging):
    """Return a function that makes a sheet for a layout."""

    def make(layout, **words):
        survey = Survey()
        survey.add(hanging())
        view = Camera().looking_at(survey.points, *layout.panel)
        return Sheet(layout, survey, StrainScale(survey.strains), view, **words)

    return make


def test_each_panel_is_where_the_layout_says(sheet_of):
    """A panel would be in the place of another, or changed on its way."""
    layout = Layout(2, 2, (60, 50))
    images = [np.full((50, 60, 3), 40 * (number + 1), np.uint8) for number in range(4)]
    whole = sheet_of(layout).compose(images, ['a', 'b', 'c', 'd'])
    assert whole.shape == (layout.size[1], layout.size[0], 3)
    for number, image in enumerate(images):
        left, top = layout.corner(number)
        top += layout.heading
        np.testing.assert_array_equal(whole[top:top + 50, left:left + 60], image)


def test_each_panel_has_its_own_heading(sheet_of):
    """A reader would not know which moment is shown."""
    layout = Layout(1, 2, (200, 100))
    images = 2 * [np.full((100, 200, 3), 255, np.uint8)]
    sheet = sheet_of(layout)
    empty, told = (sheet.compose(images, headings) for headings in (['', ''], ['', 't = 1 s']))
    changed = np.argwhere((empty != told).any(axis=-1))
    left, top = layout.corner(1)
    assert len(changed) > 20
    assert top <= changed[:, 0].min() and changed[:, 0].max() < top + layout.heading
    assert left <= changed[:, 1].min() and changed[:, 1].max() < left + 200
    # Composing does not change the sheet.
    np.testing.assert_array_equal(sheet.compose(images, ['', '']), empty)


def test_words_and_bar_stay_off_the_panels(sheet_of):
    """A long title or note, or the bar, would be written over the cloth."""
    layout = Layout(2, 1, (240, 180), has_labels=True)
    around = sheet_of(
        layout, title='a cloth', labels=['one row', 'the other'], note='note ' * 12
    ).compose([], [])
    ink = (around < 128).any(axis=-1)
    for number in range(2):
        left, top = layout.corner(number)
        assert not ink[top:top + layout.heading + 180, left:left + 240].any()
    assert ink[:layout.top].any() and ink[:, :layout.left].any()
    assert ink[:, layout.bar_left:].any()
    # The border of the sheet is free.
    assert not ink[0].any() and not ink[-1].any() and not ink[:, -1].any()


def test_a_sheet_without_strain_has_no_bar(sheet_of):
    """A bar would explain colours that are not there."""
    with_bar, without = (
        sheet_of(Layout(1, 1, (240, 180), has_bar=has_bar)).compose([], [])
        for has_bar in (True, False))
    assert without.shape[1] < with_bar.shape[1]
    assert np.ptp(without[:180], axis=-1).max() < 10


def test_the_legend_tells_of_colliders_where_there_are_some(hanging):
    """A reader would take a table for something else, or look for one that is not there."""
    ball = Collider('ball', 'sphere', (0.1,), (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0), 0.3)
    labels = []
    for colliders in ((), (ball,)):
        survey = Survey()
        survey.add(replace(hanging(), colliders=colliders))
        labels.append(labels_of(survey, Camera()))
    assert labels[1] == [labels[0][0], 'collider', *labels[0][1:]]


@pytest.mark.parametrize(('zoom', 'height', 'is_named'), [
    (1.0, 0.5, True), (5.0, 0.0, False), (5.0, 1.0, True)])
def test_the_legend_names_no_mark_out_of_view(hanging, zoom, height, is_named):
    """A reader would look for a grasp that is above the picture."""
    survey = Survey()
    frame = hanging()
    held = frame.positions[..., 2].max()
    frame.records['flags'][frame.pinned] |= FLAG_GRASPED
    survey.add(frame)
    lowest = frame.positions[..., 2].min()
    target = (0.0, 0.0, lowest + height * (held - lowest))
    assert ('grasped' in labels_of(survey, Camera(zoom=zoom, target=target))) == is_named


def labels_of(survey, camera):
    """Return the entries of the legend of a panel of 320 x 240 pixels."""
    view = camera.looking_at(survey.points, 320, 240)
    return [entry.get_label() for entry in legend_handles(survey, view, 0.1, 8.0)]
