# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The cloth as triangles in a few colours of strain, and where a ray meets it."""

from cloth_sim_ros.analysis.frame import Frame
from cloth_sim_ros.rendering.look import StrainRange
from cloth_sim_ros.rendering.look import StrainScale
from cloth_sim_ros.sim.mesh import triangles
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.snapshot import POINT_DTYPE
from cloth_sim_ros.view.surface import band_colors
from cloth_sim_ros.view.surface import BANDS
from cloth_sim_ros.view.surface import first_hit
from cloth_sim_ros.view.surface import MOST_NODES
from cloth_sim_ros.view.surface import Surface
from cut_scene import CUT
from cut_scene import cut_frame
import numpy as np
import pytest
from springs import SPRINGS


def frame_of(rows: int, cols: int, strain: np.ndarray | float) -> Frame:
    """Return a level cloth with these strains."""
    records = np.zeros((rows, cols), POINT_DTYPE)
    positions = Scene({**SPRINGS, 'rows': rows, 'cols': cols}).rest_positions()
    for axis, name in enumerate('xyz'):
        records[name] = positions[..., axis]
    records['strain'] = strain
    return Frame(0.0, records)


def test_triangles_are_drawn_once_by_strain_band():
    """The cloth would have holes, or a colour that stands for another strain."""
    strain = np.random.default_rng(3).uniform(0.0, 0.3, (7, 6)).astype(np.float32)
    frame = frame_of(7, 6, strain)
    surface = Surface(7, 6)
    drawn = {}
    for band, mesh in enumerate(surface.bands(frame, 0.2)):
        if mesh is not None:
            points, faces = mesh
            drawn.update({points[face].tobytes(): band for face in faces})
    points = frame.positions.reshape(-1, 3).astype(np.float32)
    of_triangles = strain.ravel()[triangles(7, 6)].mean(axis=1)
    assert drawn == {
        points[face].tobytes(): min(int(own / 0.2 * BANDS), BANDS - 1)
        for face, own in zip(triangles(7, 6), of_triangles)}


def test_a_strain_that_is_no_number_has_the_last_colour():
    """A state that is lost would look like a cloth at rest, or end the view."""
    strain = np.zeros((2, 3), np.float32)
    strain[:, 2] = np.nan
    bands = Surface(2, 3).bands(frame_of(2, 3, strain), 0.1)
    assert [len(mesh[1]) if mesh else 0 for mesh in (bands[0], bands[-1])] == [2, 2]


def test_a_large_cloth_is_thinned_and_keeps_its_edges():
    """A browser would stand still, or the cloth be drawn smaller than it is."""
    rows, cols = 3 * MOST_NODES, 10
    surface, frame = Surface(rows, cols), frame_of(rows, cols, 0.0)
    points = surface.points(frame)
    assert len(points) == MOST_NODES * cols
    np.testing.assert_array_equal(np.ptp(points, axis=0), np.float32((1.0, 1.0, 0.0)))
    for number in (0, 17, len(points) - 1):
        np.testing.assert_array_equal(
            frame.positions[surface.node(number)].astype(np.float32), points[number])


def test_each_band_has_a_colour_of_its_own():
    """Two strains would have the same colour."""
    assert len(set(band_colors())) == BANDS


def test_the_colours_are_those_of_pictures():
    """The same strain would have one colour in the view and another in a picture."""
    strains = StrainRange()
    strains.add(np.array([0.0, 0.1]))
    middles = (np.arange(BANDS) + 0.5) / BANDS
    pictured = 255 * StrainScale(strains, 1.0).colors(middles)[:, :3]
    # Pictures have 256 colours, which differ by up to 3.
    np.testing.assert_allclose(band_colors(), pictured, atol=2.0)


# A ray meets the cloth where geometry says.

FLAT = Scene({'rows': 5, 'cols': 9, 'width': 0.8, 'height': 0.4, 'start.z': 1.0}).rest_positions()
POINTS, FACES = FLAT.reshape(-1, 3), triangles(5, 9)


@pytest.mark.parametrize('height', [3.0, -2.0])
def test_a_ray_meets_a_level_cloth_in_its_plane(height: float):
    """A push would act beside the point that was clicked, or only on the upper side."""
    origin, target = np.array((0.7, -0.4, height)), np.array((0.13, 0.07, 1.0))
    hit = first_hit(origin, 3.0 * (target - origin), POINTS, FACES)
    np.testing.assert_allclose(hit.point, target, atol=1e-12)
    nearest = int(np.argmin(np.linalg.norm(POINTS - target, axis=1)))
    assert hit.node == nearest


@pytest.mark.parametrize(('origin', 'direction'), [
    ((0.0, 0.0, 3.0), (0.0, 0.0, 1.0)), ((0.5, 0.0, 3.0), (0.0, 0.0, -1.0)),
    ((-3.0, 0.0, 1.0), (1.0, 0.0, 0.0)), ((0.0, 0.0, 3.0), (0.0, 0.0, 0.0))],
    ids=['behind', 'beside', 'within its plane', 'no direction'])
def test_a_ray_past_the_cloth_meets_nothing(origin: tuple, direction: tuple):
    """A click on the background would push the cloth."""
    assert first_hit(origin, direction, POINTS, FACES) is None


def test_the_nearest_of_two_layers_is_met():
    """A click on a folded cloth would push the layer behind."""
    both = np.concatenate([POINTS, POINTS + (0.0, 0.0, 0.5)])
    faces = np.concatenate([FACES, FACES + len(POINTS)])
    hit = first_hit((0.01, 0.02, 3.0), (0.0, 0.0, -1.0), both, faces)
    assert hit.point[2] == pytest.approx(1.5) and hit.node >= len(POINTS)


def test_a_chain_has_no_surface_to_meet():
    """A view of a chain would end with the first click."""
    assert first_hit((0.0, 0.0, 3.0), (0.0, 0.0, -1.0), POINTS[:3], triangles(1, 3)) is None


def test_a_cut_cloth_is_drawn_and_met_where_it_is():
    """The browser would fill holes, and a click through one push the cloth."""
    scene = Scene(CUT)
    frame = cut_frame(scene)
    surface = Surface(scene.rows, scene.cols, frame.cells)
    assert len(surface.faces) == 2 * scene.cells.count
    drawn = [mesh for mesh in surface.bands(frame, 0.1) if mesh is not None]
    assert sum(len(faces) for _, faces in drawn) == 2 * scene.cells.count
    assert all(np.isfinite(points).all() for points, _ in drawn)
    points = surface.points(frame)
    assert first_hit((0.0, 0.0, 3.0), (0.0, 0.0, -1.0), points, surface.faces) is None
    hit = first_hit((0.13, 0.0, 3.0), (0.0, 0.0, -1.0), points, surface.faces)
    assert hit is not None and scene.present_nodes[surface.node(hit.node)]
