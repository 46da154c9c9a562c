# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A page shows colliders, and nodes that grasps hold, where they are."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view.drawing import COLOR
from cloth_sim_ros.view.scene_source import SceneSource
import numpy as np
from served_view import served
from view_page import ViewPage

SCENE = Scene({
    'rows': 4, 'cols': 4, 'start.z': 3.0, 'colliders.names': ['ball', 'floor'],
    'colliders.ball.shape': 'sphere', 'colliders.ball.size': [0.2],
    'colliders.ball.position': [0.1, 0.2, 0.3], 'colliders.floor.shape': 'plane',
    'collider_moves.start': [0.0], 'collider_moves.name': ['ball'],
    'collider_moves.target': [1.1, 0.2, 0.3], 'collider_moves.orientation': [0.0, 0.0, 1.0, 1.0],
    'collider_moves.speed': [1.0], 'collider_moves.angular_speed': [9.0]})


def test_the_page_shows_the_colliders_and_moves_them():
    """The cloth would hang over something that nobody sees, or sees elsewhere."""
    source = SceneSource(SCENE, 'small', frame_seconds=0.02, is_paused=True)
    with served(source) as address, ViewPage(address) as page:
        page.wait_for(lambda: '/colliders/floor' in page.nodes, 'a floor')
        ball = page.nodes['/colliders/ball']
        np.testing.assert_allclose(ball['position'], (0.1, 0.2, 0.3))
        assert tuple(ball['color']) == COLOR
        points = ball['vertices'].reshape(-1, 3)
        np.testing.assert_allclose(np.linalg.norm(points, axis=1), 0.2, rtol=1e-5)
        source.step(round(0.5 / SCENE['dt']))
        # The view may show it on its way.
        page.wait_for(lambda: np.allclose(
            page.nodes['/colliders/ball']['position'], (0.6, 0.2, 0.3), rtol=0.0, atol=1e-6),
            'a ball that moved')
        # Half of the quarter turn.
        half = (np.cos(np.pi / 8), 0.0, 0.0, np.sin(np.pi / 8))
        page.wait_for(lambda: np.allclose(
            page.nodes['/colliders/ball'].get('wxyz', (1.0, 0.0, 0.0, 0.0)), half, rtol=0.0,
            atol=1e-6), 'a turn')


def test_the_page_tells_grasped_nodes_from_pins():
    """A gripper would look like a peg."""
    scene = Scene({
        'rows': 4, 'cols': 4, 'pins': ['top_left'], 'start.z': 3.0, 'grasps.start': [0.0],
        'grasps.name': ['hand'], 'grasps.position': [0.5, 0.0, 3.0], 'grasps.count': [1]})
    source = SceneSource(scene, 'small', frame_seconds=0.02, is_paused=True)
    with served(source) as address, ViewPage(address) as page:
        source.step(1)
        page.wait_for(
            lambda: '/cloth/grasped' in page.nodes and len(page.dots('/cloth/grasped')) == 1,
            'a node that is held')
        assert len(page.dots('/cloth/pins')) == 1


def test_a_lamp_and_a_floor_show_where_the_cloth_is():
    """A cloth in the void has no depth, and its folds no shade."""
    free = Scene({'rows': 4, 'cols': 4, 'start.z': 3.0})
    for scene, level in ((free, None), (SCENE, 0.0)):
        source = SceneSource(scene, 'small', frame_seconds=0.02, is_paused=True)
        lowest = float(source.latest().frame.positions[..., 2].min())
        with served(source) as address, ViewPage(address) as page:
            page.wait_for(lambda: '/floor' in page.nodes, 'a floor')
            page.wait_for(lambda: '/lights/lamp' in page.nodes, 'a lamp')
            page.wait_for(
                lambda: page.nodes['/lights/lamp']['position'][2] > lowest, 'a lamp above it')
            page.wait_for(
                lambda: page.nodes['/floor']['position'][2] < lowest, 'a floor below it')
            if level is not None:
                assert page.nodes['/floor']['position'][2] == level
