# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Every shader that draws, in every form, is portable GLSL.

Apart from test/shaders, which runs where there is no matplotlib.
"""

from pathlib import Path

from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.rendering.cloth_drawing import CLOTH_DEFINES
from cloth_sim_ros.rendering.cloth_drawing import LIMIT_DEFINES
from cloth_sim_ros.rendering.daylight import CHECKED_DEFINES
from cloth_sim_ros.rendering.daylight import DAYLIGHT_DEFINES
from cloth_sim_ros.rendering.daylight import FLOOR_DEFINES
from cloth_sim_ros.rendering.daylight import KNIT_DEFINES
from cloth_sim_ros.rendering.daylight import TWILL_DEFINES
from cloth_sim_ros.rendering.daylight import WOVEN_DEFINES
from cloth_sim_ros.rendering.look import LIGHT_DEFINES
from cloth_sim_ros.rendering.solid_drawing import ARROW_DEFINES
from cloth_sim_ros.rendering.solid_drawing import BALL_DEFINES
from cloth_sim_ros.rendering.solid_drawing import RIBBON_DEFINES
from portable import assert_accepted
import pytest

_SHADOW = {'SHADOW': 1}
_FORMS = {
    'arrow.frag': [ARROW_DEFINES, LIGHT_DEFINES],
    'arrow.vert': [ARROW_DEFINES],
    'ball.frag': [BALL_DEFINES],
    'ball.vert': [BALL_DEFINES],
    'body.frag': [DAYLIGHT_DEFINES],
    'cloth.frag': [CLOTH_DEFINES, LIMIT_DEFINES],
    'cloth.vert': [CLOTH_DEFINES, LIMIT_DEFINES, _SHADOW, DAYLIGHT_DEFINES],
    'collider.vert': [LIGHT_DEFINES, DAYLIGHT_DEFINES],
    'fabric.frag': [
        DAYLIGHT_DEFINES, CHECKED_DEFINES, WOVEN_DEFINES, TWILL_DEFINES, KNIT_DEFINES],
    'floor.frag': [{}],
    'floor.vert': [{}, DAYLIGHT_DEFINES],
    'ground.frag': [{}],
    'lit_floor.frag': [FLOOR_DEFINES],
    'plain.frag': [_SHADOW],
    'ribbon.frag': [RIBBON_DEFINES],
    'ribbon.vert': [RIBBON_DEFINES],
}


def test_every_shader_is_looked_at():
    """A new shader would be tried on one driver only."""
    assert {path.name for path in (shader_directory() / 'render').iterdir()} == set(_FORMS)


@pytest.mark.parametrize(
    ('name', 'defines'), [(name, defines) for name, forms in _FORMS.items() for defines in forms])
def test_glslang_accepts_the_shader(tmp_path: Path, name: str, defines: dict):
    """The picture would be drawn on one driver's leniency only."""
    assert_accepted(tmp_path, f'render/{name}', defines)


@pytest.mark.parametrize('name', _FORMS)
def test_version_is_430_core(name: str):
    """A device with OpenGL 4.3 could not run it."""
    lines = (shader_directory() / 'render' / name).read_text().splitlines()
    assert '#version 430 core' in lines
