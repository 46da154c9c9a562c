# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A cloth is cut to an outline, a disc, holes or a mask, or the shape is refused whole."""

import math
import struct
import zlib

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.given_values import load_parameters
from cloth_sim_ros.sim.scene import Scene
import numpy as np
from PIL import Image
import pytest

CLOTH = {'rows': 41, 'cols': 51, 'width': 0.5, 'height': 0.4, 'pins': ('none',)}
HOLE = (-0.1, -0.05, 0.1, -0.05, 0.1, 0.05, -0.1, 0.05)


def cut(**shape):
    """Return the scene of a cloth of 0.5 m x 0.4 m in cells of 1 cm."""
    return Scene({**CLOTH, **{f'shape.{name}': value for name, value in shape.items()}})


def area(scene):
    """Return the area of the cells that there are [m2]."""
    return scene.cells.count * math.prod(scene.spacing)


def test_a_cloth_without_a_shape_has_all_cells():
    """A rectangle would have holes, or pay for being able to have some."""
    scene = Scene(CLOTH)
    assert scene.cells.present.all() and scene.cut_cells is None and not scene.has_gaps
    assert Scene({**CLOTH, 'material.preset': 'none'}).cells is None


@pytest.mark.parametrize('outline', [
    (-0.25, -0.2, 0.25, -0.2, 0.25, 0.2),
    (-0.25, 0.2, 0.05, 0.2, 0.05, 0.0, 0.25, 0.0, 0.25, -0.2, -0.25, -0.2),
    (0.0, 0.18, 0.2, -0.1, 0.1, -0.19, -0.17, -0.12)], ids=['triangle', 'L', 'quadrangle'])
def test_an_outline_has_its_area(outline):
    """A garment part would weigh something else than its pattern says."""
    x, y = np.reshape(outline, (-1, 2)).T
    exact = 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    scene = cut(outline=outline)
    assert area(scene) == pytest.approx(exact, rel=5e-3)
    assert scene.mass == pytest.approx(scene['areal_density'] * area(scene))


def test_an_outline_is_seen_from_above():
    """A part would be mirrored, or lie on its head: y grows towards row 0."""
    cells = cut(outline=(-0.25, 0.2, 0.0, 0.2, 0.0, 0.0, -0.25, 0.0)).cells.present
    assert cells[:20, :25].all() and cells.sum() == 20 * 25


@pytest.mark.parametrize('nodes', [15, 32, 71, 128])
@pytest.mark.parametrize('height', [0.3, 0.4])
def test_a_disc_has_its_area_and_symmetry(nodes, height):
    """A round cloth would weigh more on one grid than on another."""
    scene = Scene({**CLOTH, 'rows': nodes, 'cols': nodes, 'width': 0.3, 'height': height,
                   'shape.disc': 0.29})
    cells = scene.cells.present
    # At most 8 cells are at one distance.
    assert abs(area(scene) / (math.pi * 0.145**2) - 1.0) < 4.5 / cells.sum()
    np.testing.assert_array_equal(cells, cells[::-1])
    np.testing.assert_array_equal(cells, cells[:, ::-1])
    if height == 0.3:
        np.testing.assert_array_equal(cells, cells.T)


def test_holes_are_cut_out():
    """A cloth would be whole, or one hole of several be forgotten."""
    second = tuple(np.add(HOLE, (0.0, 0.12) * 4))
    assert area(cut(holes=HOLE)) == pytest.approx(0.2 - 0.02)
    two = cut(holes=(*HOLE, *second), hole_corners=(4, 4))
    assert area(two) == pytest.approx(0.2 - 0.04)
    assert not two.cells.present[15:25, 15:35].any()
    assert two.cells.present[14, 20] and not two.cells.present[8, 20]
    assert area(cut(disc=0.38, holes=HOLE)) == pytest.approx(math.pi * 0.19**2 - 0.02, rel=5e-3)


# Which cells are white in the masks.
WHITE = np.zeros((40, 50), dtype=bool)
WHITE[3:30, 5:20] = WHITE[20:38, 10:45] = True


def white_parts(path, kind='L', pixels=4):
    """Write a mask of so many pixels along each side of a cell."""
    grey = np.kron(WHITE, np.full((pixels, pixels), 255))
    Image.fromarray(grey.astype(np.uint8)).convert(kind).save(path)
    return str(path)


@pytest.mark.parametrize(('name', 'kind', 'pixels'), [
    ('mask.png', 'L', 1), ('mask.png', 'RGB', 2), ('mask.bmp', '1', 3), ('mask.jpg', 'L', 8)])
def test_a_mask_is_laid_over_the_cloth(tmp_path, name, kind, pixels):
    """Cloth would be where the image is black, or shifted."""
    scene = cut(mask=white_parts(tmp_path / name, kind, pixels))
    np.testing.assert_array_equal(scene.cells.present, WHITE)


def test_a_scene_carries_its_mask(tmp_path):
    """A recording could not be simulated again once the image is gone."""
    path = tmp_path / 'mask.png'
    scene = cut(mask=white_parts(path))
    path.unlink()
    np.testing.assert_array_equal(Scene(scene.values).cells.present, scene.cells.present)
    assert scene['shape.mask'].startswith('data:image/png;base64,')


def test_a_mask_is_beside_the_scene_file(tmp_path, monkeypatch):
    """A scene could be run from one working directory only."""
    white_parts(tmp_path / 'mask.png')
    for mask in ('mask.png', str(tmp_path / 'mask.png')):
        (tmp_path / 'scene.yaml').write_text(
            f'/**: {{ros__parameters: {{shape.mask: {mask}, pins: [none]}}}}\n')
        values = load_parameters(tmp_path / 'scene.yaml')
        assert not Scene(values).cells.present.all()


def test_nodes_are_those_of_the_cells():
    """Nodes without cloth would weigh, or those of a border be missing."""
    scene = cut(outline=(-0.25, 0.2, 0.0, 0.2, 0.0, 0.0, -0.25, 0.0))
    assert scene.has_gaps and scene.spanned == (21, 26)
    expected = np.zeros((41, 51), dtype=bool)
    expected[:21, :26] = True
    np.testing.assert_array_equal(scene.present_nodes, expected)
    # A hole of one cell takes no node.
    small = (-0.005, -0.005, 0.005, -0.005, 0.005, 0.005, -0.005, 0.005)
    scene = cut(holes=tuple(np.add(small, 0.005)))
    assert scene.cells.count == 40 * 50 - 1 and not scene.has_gaps
    assert scene.cut_cells is not None


def test_springs_can_be_cut_as_well():
    """A shape would ask for a material."""
    scene = Scene({**CLOTH, 'shape.disc': 0.3, 'stiffness.structural': 100.0})
    assert scene.has_gaps and scene.mass == pytest.approx(0.2 * area(scene))


def test_a_total_mass_is_that_of_the_shape():
    """A round towel would lose the weight of its corners."""
    assert Scene({**CLOTH, 'shape.disc': 0.3, 'total_mass': 0.1}).mass == pytest.approx(0.1)


def huge_image(path):
    """Write the head of a PNG of 1e9 pixels."""
    head = struct.pack('>IIBBBBB', 40000, 25000, 8, 0, 0, 0, 0)
    path.write_bytes(
        b'\x89PNG\r\n\x1a\n' + struct.pack('>I', len(head)) + b'IHDR' + head
        + struct.pack('>I', zlib.crc32(b'IHDR' + head)) + struct.pack('>I', 0) + b'IDAT'
        + struct.pack('>I', zlib.crc32(b'IDAT')))
    return str(path)


def black(path):
    """Write an image without white."""
    Image.new('L', (4, 4)).save(path)
    return str(path)


@pytest.mark.parametrize(('shape', 'said'), [
    ({'disc': 1e-3}, 'the shape leaves no cell'),
    ({'disc': 0.1, 'holes': tuple(np.multiply(HOLE, 1.5))}, 'the shape leaves no cell'),
    ({'mask': black}, 'the shape leaves no cell'),
    ({'holes': (-0.3, -0.05, 0.3, -0.05, 0.3, 0.05, -0.3, 0.05)}, 'falls into 2 pieces'),
    ({'outline': (-0.25, 0.2, 0.0, 0.2, 0.0, 0.003, 0.25, -0.003, 0.25, -0.2, 0.003, -0.2,
                  -0.003, -0.003, -0.25, 0.0)}, 'single node'),
    ({'outline': (0.0, 0.0, 0.1, 0.1, 0.0, 0.1, 0.1, 0.0)}, 'crosses itself'),
    ({'holes': (0.0, 0.0, 0.1, 0.1, 0.0, 0.1, 0.1, 0.0)}, 'crosses itself'),
    ({'outline': (0.0, 0.0, 0.1, 0.1)}, '3 corners or more, got 4 numbers'),
    ({'outline': (0.0, 0.0, 0.1, 0.1, 0.1, 0.0, 0.2)}, '3 corners or more, got 7 numbers'),
    ({'holes': HOLE, 'hole_corners': (3,)}, 'give how many corners each hole has'),
    ({'mask': 'nowhere.png'}, "'nowhere.png' cannot be read (No such file"),
    ({'mask': lambda path: str(path.parent)}, 'is a folder'),
    ({'mask': lambda path: path.write_text('none') and str(path)}, 'is no image that can be read'),
    ({'mask': 'data:image/png;base64,AAAA'}, 'is no image that can be read'),
    ({'mask': 'data:image/png;base64,*'}, 'is not base64'),
    ({'mask': huge_image}, 'more than 67108864 pixels')])
def test_a_bad_shape_is_refused_in_one_sentence(tmp_path, shape, said):
    """A cloth would be another than was asked for, or the memory be filled by an image."""
    given = {name: value(tmp_path / 'mask.png') if callable(value) else value
             for name, value in shape.items()}
    with pytest.raises(ClothSimError) as caught:
        cut(**given)
    message = str(caught.value)
    assert said in message and ': ' in message and '\n' not in message and len(message) < 300


@pytest.mark.parametrize('others', [
    {'rows': 1}, {'node_mass': 0.1}, {'layout': 'paper'}, {'adaptive.scheme': 'paper'}])
def test_a_shape_needs_cells(others):
    """A chain, or the paper's nodes of equal mass, would be cut without a word."""
    with pytest.raises(ClothSimError, match='cut out of'):
        Scene({**CLOTH, 'shape.disc': 0.1, 'air.density': 0.0, **others})


def test_pins_are_nodes_that_are_there():
    """A cloth would be held where it is not, and fall."""
    disc = {**CLOTH, 'shape.disc': 0.4}
    for pins in (['top_left'], ['0,0'], ['top_edge', 'bottom_right']):
        with pytest.raises(ClothSimError, match='where the shape of the cloth has no node'):
            Scene({**disc, 'pins': pins})
    pinned = Scene({**disc, 'pins': ['top_edge']}).pinned_nodes()
    assert pinned.any() and not pinned[~Scene(disc).present_nodes].any()
    # The nearest node that is there.
    near = Scene({**disc, 'pin_points.positions': (0.15, 0.15, 1.0)})
    assert near.pinned_nodes().sum() == 1
    with pytest.raises(ClothSimError, match='pin_points'):
        Scene({**disc, 'pin_points.positions': (-0.24, 0.19, 1.0)})
