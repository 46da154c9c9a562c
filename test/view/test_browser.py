# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""The page of a view in a real browser."""

import io
from pathlib import Path

from browser import Browser
from cloth_sim_ros.sim.scene import Scene
from cloth_sim_ros.view.scene_source import SceneSource
import numpy as np
from PIL import Image
import pytest
from served_view import served

SCENE = Scene({
    'rows': 16, 'cols': 16, 'start.jitter': 0.01, 'stiffness.structural': 60.0,
    'stiffness.shear': 20.0})


@pytest.mark.long
def test_a_browser_draws_the_cloth_and_steers_it(tmp_path: Path):
    """The page would be empty in a browser, or its buttons do nothing."""
    source = SceneSource(SCENE, 'towel', frame_seconds=0.02, is_paused=True)
    source.step(100)
    with served(source) as address:
        with Browser(tmp_path, address) as browser:
            browser.wait_for('towel, paused')
            # The first images come before the cloth is there.
            drawn = browser.picture()
            while not _has_cloth(drawn):
                drawn = browser.picture()
            browser.press('Step')
            browser.wait_for(f't = {101 * SCENE["dt"]:.2f} s')
            browser.press('Reset')
            browser.wait_for('t = 0.00 s')


def _has_cloth(picture: bytes) -> bool:
    """Return whether some of the left half is bluish, as a cloth that hardly stretches is."""
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert('RGB')).astype(int)
    red, _, blue = np.moveaxis(pixels[:, :pixels.shape[1] // 2], -1, 0)
    return float((blue - red > 5).mean()) > 0.01
