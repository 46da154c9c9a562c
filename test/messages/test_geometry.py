# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What viewers draw: triangles coloured by strain, a line for a chain, arrows of pushes."""

from cloth_sim_ros.messages.geometry import FULL_STRAIN
from cloth_sim_ros.messages.geometry import MOST_DRAWN
from cloth_sim_ros.messages.geometry import push_arrows
from cloth_sim_ros.messages.geometry import serialise_topology
from cloth_sim_ros.messages.geometry import strain_colors
from cloth_sim_ros.messages.geometry import Surface
from cloth_sim_ros.messages.geometry import surface_bytes
from cloth_sim_ros.sim.mesh import triangles
from cloth_sim_ros.sim.model.push import Push
from cloth_sim_ros.sim.scene import Scene
from cut_scene import CUT
from cut_scene import cut_snapshot
from matplotlib import colormaps
import numpy as np
import pytest
from rclpy.serialization import deserialize_message
from shape_msgs.msg import Mesh
from springs import SPRINGS

NODES = np.array([[0.0, 0.0, 1.0], [2.0, 4.0, 1.0]])


def test_only_pushes_that_act_are_shown():
    """A push would show before it begins or after it ends."""
    push = Push.checked(force=(0.0, 0.0, 2.0), start=1.0, duration=0.5)
    shown = [len(push_arrows([push], time, NODES, 1.0)) for time in (0.99, 1.0, 1.49, 1.5)]
    assert shown == [0, 1, 1, 0]


def test_push_arrow_positions_and_directions():
    """A push would show somewhere else, in another direction or strength."""
    everywhere = Push.checked(force=(0.0, 0.0, -4.0), start=0.0, duration=1.0)
    sphere = Push.checked(
        force=(2.0, 0.0, 0.0), start=0.0, duration=1.0, region='sphere',
        center=(5.0, 6.0, 7.0), radius=0.1)
    first, second = push_arrows([everywhere, sphere], 0.5, NODES, 0.3)
    np.testing.assert_allclose(first, [[1.0, 2.0, 1.0], [1.0, 2.0, 0.7]])
    np.testing.assert_allclose(second, [[5.0, 6.0, 7.0], [5.15, 6.0, 7.0]])


def test_a_push_without_force_has_no_arrow():
    """The arrow of a zero force would have a direction that is not a number."""
    push = Push.checked(force=(0.0, 0.0, 0.0), start=0.0, duration=1.0)
    assert push_arrows([push], 0.5, NODES, 1.0) == []


# Which nodes are drawn.


@pytest.mark.parametrize(('rows', 'cols', 'pose'), [
    (3, 5, 'horizontal'), (4, 2, 'hanging'), (1, 6, 'hanging')])
def test_mesh_is_the_scene_at_rest(rows, cols, pose):
    """A viewer would draw another cloth than the one simulated."""
    scene = Scene({**SPRINGS, 'rows': rows, 'cols': cols, 'start.pose': pose, 'start.jitter': 0.2})
    mesh = deserialize_message(serialise_topology(scene), Mesh)
    nodes = np.array([[node.x, node.y, node.z] for node in mesh.vertices])
    np.testing.assert_array_equal(nodes, scene.rest_positions().reshape(-1, 3))
    faces = np.array([face.vertex_indices for face in mesh.triangles]).reshape(-1, 3)
    np.testing.assert_array_equal(faces, triangles(rows, cols))


def test_colours_are_those_of_viridis():
    """Equal steps of strain would not look equal."""
    strain = np.linspace(0.0, FULL_STRAIN, 101)
    np.testing.assert_allclose(
        strain_colors(strain), colormaps['viridis'](np.linspace(0.0, 1.0, 101)), atol=0.06)


def test_brightness_grows_with_strain():
    """A larger strain could look smaller, above all in grey."""
    brightness = strain_colors(np.linspace(0.0, FULL_STRAIN, 101))[:, :3] @ [0.299, 0.587, 0.114]
    assert np.all(np.diff(brightness) > 0.0)


def test_beyond_the_scale_is_the_last_colour():
    """A torn or broken cloth would show as one at rest."""
    colors = strain_colors(np.array([[FULL_STRAIN, 1.0], [np.inf, np.nan]], np.float32))
    assert colors.shape == (2, 2, 4) and colors.dtype == np.float32
    np.testing.assert_array_equal(colors, np.broadcast_to(colors[0, 0], (2, 2, 4)))


def lattice(rows, cols):
    """Return positions that tell their node: (row, col, 0)."""
    row, col = np.mgrid[:rows, :cols]
    return np.stack([row, col, 0 * row], axis=-1).astype(np.float32)


def test_every_triangle_is_drawn():
    """The surface would miss cells or join nodes that are no neighbours."""
    surface = Surface(3, 4, max_side=256)
    points = surface.points(surface.sample(lattice(3, 4)))
    expected = lattice(3, 4).reshape(-1, 3)[triangles(3, 4).ravel()]
    assert points.dtype == np.float64
    np.testing.assert_array_equal(points, expected)


def test_colours_go_with_their_points():
    """A node's strain would show at another node."""
    surface = Surface(3, 4, max_side=256)
    colors = np.random.default_rng(1).random((3, 4, 4), dtype=np.float32)
    drawn = surface.colors(surface.sample(colors))
    np.testing.assert_array_equal(drawn, colors.reshape(-1, 4)[triangles(3, 4).ravel()])


def test_a_large_cloth_is_sampled_to_its_edges():
    """A large cloth would be drawn smaller than it is, or in messages of hundreds of MB."""
    surface = Surface(100, 30, max_side=10)
    points = surface.points(surface.sample(lattice(100, 30)))
    assert len(points) == 6 * 9 * 9
    assert points.min(axis=0).tolist() == [0, 0, 0]
    assert points.max(axis=0).tolist() == [99, 29, 0]
    assert len(np.unique(points[:, 0])) == len(np.unique(points[:, 1])) == 10


@pytest.mark.parametrize(('rows', 'cols'), [(1, 300), (300, 1)])
def test_a_chain_is_drawn_node_by_node(rows, cols):
    """A chain, which has no triangles, would be invisible."""
    surface = Surface(rows, cols, max_side=256)
    assert surface.is_chain
    points = surface.points(surface.sample(lattice(rows, cols)))
    np.testing.assert_array_equal(points, lattice(rows, cols).reshape(-1, 3))


@pytest.mark.parametrize(('rows', 'cols'), [(1, 300), (300, 1), (3, 4), (300, 20)])
def test_its_size_is_known_beforehand(rows, cols):
    """The shared memory would be chosen for messages of another size."""
    surface = Surface(rows, cols, MOST_DRAWN)
    points = surface.points(surface.sample(lattice(rows, cols)))
    colors = surface.colors(surface.sample(np.zeros((rows, cols, 4), np.float32)))
    assert surface_bytes(rows, cols) == points.nbytes + colors.nbytes


def test_mesh_of_a_cut_cloth_has_its_cells():
    """A viewer would fill the holes, or draw triangles to the origin."""
    scene = Scene(CUT)
    mesh = deserialize_message(serialise_topology(scene), Mesh)
    faces = np.array([face.vertex_indices for face in mesh.triangles]).reshape(-1, 3)
    assert len(faces) == 2 * scene.cells.count
    assert scene.present_nodes.ravel()[faces].all()
    np.testing.assert_array_equal(faces, triangles(scene.rows, scene.cols, scene.cells.present))


@pytest.mark.parametrize('max_side', [256, 9])
def test_the_surface_of_a_cut_cloth_has_its_cells(max_side):
    """Corners of triangles would be NaN, which viewers refuse or draw across the scene."""
    scene = Scene(CUT)
    surface = Surface(scene.rows, scene.cols, max_side, scene.cut_cells)
    points = surface.points(surface.sample(cut_snapshot(scene).positions))
    assert np.isfinite(points).all()
    if max_side == 256:
        assert len(points) == 6 * scene.cells.count
    # None is drawn within the hole.
    middles = points.reshape(-1, 3, 3).mean(axis=1)
    assert not np.any(np.all(np.abs(middles[:, :2]) < 0.03, axis=1))
