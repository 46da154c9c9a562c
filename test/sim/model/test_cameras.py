# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Cameras of a scene: their parameters, and where they look."""

from cloth_sim_ros.sim.errors import ClothSimError
from cloth_sim_ros.sim.model.cameras import CameraModel
from cloth_sim_ros.sim.model.cameras import looking_at
from cloth_sim_ros.sim.scene import Scene
import numpy as np
import pytest

FRONT = {
    'cameras.names': ['front'], 'cameras.front.position': [1.0, 0.0, 1.0],
    'cameras.front.target': [0.0, 0.0, 0.5]}


@pytest.mark.parametrize('target', [
    (0.0, 0.0, 0.0), (1.0, 2.0, 0.0), (1.0, 2.0, 9.0), (-3.0, 5.0, 3.0)])
def test_the_target_is_in_the_middle_with_z_up(target):
    """The picture would be turned, or show something else."""
    pose = looking_at((1.0, 2.0, 3.0), target)
    x, y, z = pose.seen_from(np.array([target]))[0]
    assert abs(x) < 1e-12 and abs(y) < 1e-12
    assert z == pytest.approx(np.linalg.norm(np.subtract(target, (1.0, 2.0, 3.0))))
    right, down, forward = pose.axes
    np.testing.assert_allclose(np.cross(right, down), forward, atol=1e-12)
    assert abs(right[2]) < 1e-12 and down[2] < 1e-12


def test_the_field_of_view_is_the_width_of_the_picture():
    """A lens would be wider or narrower than its data sheet says."""
    camera = CameraModel.of(target=[0.0, 0.0, 1.0], width=641, height=481, field_of_view=90.0)
    assert camera.fx == camera.fy == pytest.approx(320.5)
    assert (camera.cx, camera.cy) == (320.0, 240.0)
    # From edge to edge of the picture, which is half a pixel beyond the middles.
    edges = camera.project(np.array([(-1.0, 0.0, 1.0), (1.0, 0.0, 1.0)]))
    np.testing.assert_allclose(edges[:, 0], [-0.5, 640.5])


def test_rays_are_the_inverse_of_the_projection():
    """Points of a cloud would be beside what their pixels see."""
    camera = CameraModel.of(
        target=[0.0, 0.0, 1.0], width=7, height=5, intrinsics=[8.0, 9.0, 2.5, 2.25])
    rays = np.concatenate([camera.rays(), np.ones((5, 7, 1))], axis=-1)
    v, u = np.indices((5, 7))
    np.testing.assert_allclose(camera.project(2.0 * rays), np.stack([u, v], axis=-1), atol=1e-12)


def test_cameras_are_in_the_order_of_their_names():
    """A program would take one camera for another."""
    scene = Scene({**FRONT, 'cameras.names': ['front', 'hand'], 'cameras.hand.frame': 'tool0'})
    assert [camera.name for camera in scene.cameras] == ['front', 'hand']
    assert [camera.frame for camera in scene.cameras] == ['', 'tool0']
    assert Scene({}).cameras == ()


@pytest.mark.parametrize('wrong, rule', [
    ({'cameras.names': ['front', 'front']}, 'cameras.names has a name twice: give each camera'),
    ({'cameras.names': ['front', 'Back']}, "cameras.names has 'Back': give lower-case letters"),
    ({'cameras.names': [f'c{k}' for k in range(17)]}, 'has 17 entries: give at most 16 cameras'),
    ({'cameras.front.zoom': 2.0}, 'there is no parameter cameras.front.zoom'),
    ({'cameras.back.width': 2}, 'list back in cameras.names'),
    ({'cameras.front.position': [1.0]}, 'cameras.front.position needs 3 numbers, got 1'),
    ({'cols': 1}, 'cameras see surfaces, and a chain of rows 32 x cols 1 has none'),
])
def test_wrong_cameras_are_refused(wrong, rule):
    """A node would start with a camera that shows nothing."""
    values = {**FRONT, **wrong}
    if 'front' not in values['cameras.names']:
        values = {name: value for name, value in values.items() if '.front.' not in name}
    with pytest.raises(ClothSimError, match=rule.replace('[', r'\[')):
        Scene(values)
