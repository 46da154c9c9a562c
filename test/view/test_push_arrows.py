# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A page shows the pushes that act."""

from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view.push_arrows import COLOR
from cloth_sim_ros.view.scene_source import SceneSource
import numpy as np
from served_view import served
from view_page import ViewPage

SCENE = Scene({
    'rows': 4, 'cols': 4, 'start.z': 3.0, 'pushes.start': [0.0], 'pushes.duration': [0.1],
    'pushes.force': [0.0, 2.0, 0.0]})


def test_an_arrow_stands_as_long_as_its_push_acts():
    """A cloth would move for no visible reason, or an arrow would stay when it is over."""
    source = SceneSource(SCENE, 'small', frame_seconds=0.02, is_paused=True)
    with served(source) as address, ViewPage(address) as page:
        arrows = page.wait_for(lambda: page.nodes.get('/pushes'), 'an arrow')
        (tail, tip), = arrows['points'].reshape(-1, 2, 3)
        assert (tip - tail)[1] > 0.1
        np.testing.assert_allclose((tip - tail)[[0, 2]], 0.0, atol=1e-6)
        assert tuple(arrows['colors'].ravel()[:3]) == COLOR
        source.step(round(0.2 / SCENE['dt']))
        page.wait_for(lambda: page.nodes['/pushes'].get('visible') is False, 'no arrow')
