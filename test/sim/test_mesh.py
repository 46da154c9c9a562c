# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The surface of a cloth as triangles."""

from cloth_sim_ros.sim.mesh import mesh_of_nodes
from cloth_sim_ros.sim.mesh import triangles
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.sim.simulation import Simulation
import numpy as np
import pytest
from springs import SPRINGS

SIDE = 33
SIZE = 0.3  # [m]
DISC = {
    **SPRINGS, 'rows': SIDE, 'cols': SIDE, 'width': SIZE, 'height': SIZE, 'pins': ('none',),
    'shape.disc': SIZE}


def flat_areas(vertices, corners):
    """Return the area of each triangle as a vector, (m, 3) [m2]."""
    a, b, c = (vertices[corners[:, corner]].astype(float) for corner in range(3))
    return np.cross(b - a, c - a) / 2


def test_each_cell_is_covered_once():
    """The surface would have holes or overlap."""
    rows, cols = 4, 6
    positions = Scene({
        **SPRINGS, 'rows': rows, 'cols': cols, 'width': 5.0, 'height': 3.0}).rest_positions()
    vertices, corners = positions.reshape(-1, 3), triangles(rows, cols)
    np.testing.assert_allclose(
        flat_areas(vertices, corners), np.tile([0.0, 0.0, 0.5], (2 * 3 * 5, 1)), atol=1e-12)
    cells = np.floor(vertices[corners].mean(axis=1)[:, :2] - positions[-1, 0, :2])
    assert sorted(map(tuple, cells)) == sorted(
        2 * [(float(col), float(row)) for row in range(3) for col in range(5)])


def test_a_chain_has_no_faces():
    """A chain would be drawn with faces of nothing."""
    assert triangles(1, 9).shape == triangles(9, 1).shape == (0, 3)


@pytest.mark.parametrize('shape', [(1, 9), (9, 1)])
def test_the_mesh_of_a_chain_is_its_nodes(shape):
    """The nodes would be taken for those that a shape cuts away."""
    positions = np.arange(27.0).reshape(*shape, 3)
    present = np.ones((shape[0] - 1, shape[1] - 1), bool)
    mesh = mesh_of_nodes(positions, positions, present)
    np.testing.assert_array_equal(mesh.vertices, positions.reshape(-1, 3))
    assert mesh.uv.shape == (9, 2) and mesh.triangles.shape == (0, 3)


@pytest.mark.parametrize('changes', [{}, {'shape.disc': 0.0}], ids=['disc', 'rectangle'])
def test_the_mesh_of_a_simulation(context, changes):
    """Textures, areas or the lit side of a cloth in another program would be wrong."""
    scene = Scene({**DISC, **changes})
    with Simulation(scene, context=context) as cloth:
        middle = cloth.positions()[SIDE // 2, SIDE // 2]
        cloth.push((0.0, 0.0, 0.02), duration=0.05, region='sphere', center=middle, radius=0.05)
        cloth.advance(0.05)
        snapshot = cloth.snapshot()
        assert np.nanmin(snapshot.normals[..., 2]) < 0.99
        mesh = snapshot.mesh()
    cells = (SIDE - 1)**2 if scene.cells is None else scene.cells.count
    assert mesh.triangles.shape == (2 * cells, 3) and mesh.triangles.dtype == np.int32
    for values, width in ((mesh.vertices, 3), (mesh.normals, 3), (mesh.uv, 2)):
        assert values.shape == (scene.present_nodes.sum(), width) and values.dtype == np.float32
        assert np.isfinite(values).all()
    np.testing.assert_array_equal(mesh.vertices, snapshot.positions[scene.present_nodes])
    areas = flat_areas(mesh.vertices, mesh.triangles)
    assert np.linalg.norm(areas, axis=1).sum() == pytest.approx(
        cells * (SIZE / (SIDE - 1))**2, rel=1e-3)
    assert ((areas[:, None] * mesh.normals[mesh.triangles]).sum(axis=-1) > 0.0).all()
    # Row 0 is at y of half the height.
    flat = (mesh.uv - 0.5) * SIZE
    np.testing.assert_allclose(flat, scene.rest_positions()[scene.present_nodes][:, :2], atol=1e-7)


def test_nodes_that_are_cut_away_are_left_out():
    """Vertices of NaN would be in the way of every program that opens the mesh."""
    positions = np.arange(36.0).reshape(3, 4, 3)
    present = np.array([[False, True, True], [False, False, True]])
    mesh = mesh_of_nodes(positions, positions, present)
    assert mesh.vertices[:, 0].tolist() == [3.0, 6.0, 9.0, 15.0, 18.0, 21.0, 30.0, 33.0]
    assert mesh.triangles.tolist() == [
        [0, 3, 1], [1, 3, 4], [1, 4, 2], [2, 4, 5], [4, 6, 5], [5, 6, 7]]
