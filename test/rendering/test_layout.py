# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Panels have the size and places that a sheet needs."""

from cloth_sim_ros.rendering.camera import Camera
from cloth_sim_ros.rendering.layout import Layout
from cloth_sim_ros.rendering.layout import panel_size
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
