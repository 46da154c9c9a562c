# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Every shader of the cameras, in every form, is portable GLSL."""

from pathlib import Path

from cloth_sim_ros.camera.color_drawing import FABRIC_DEFINES
from cloth_sim_ros.camera.color_drawing import PRINT_DEFINES
from cloth_sim_ros.camera.light import DAYLIGHT_DEFINES
from cloth_sim_ros.camera.traced_body import traced_defines
from cloth_sim_ros.gl.shared_directory import shader_directory
from cloth_sim_ros.sim.model.colliders import SHAPES
from portable import assert_accepted
import pytest

_GAPS = [{}, {'HAS_GAPS': 1}]
_NORMALS = [{}, {'HAS_NORMALS': 1}]
_FORMS = {
    'backdrop.frag': [{}],
    'body.vert': [{}],
    'body_color.frag': [
        DAYLIGHT_DEFINES, *({**DAYLIGHT_DEFINES, **traced_defines(shape)} for shape in SHAPES)],
    'body_depth.vert': [{}],
    'body_values.frag': [
        {**normals, **traced_defines(shape)} for normals in _NORMALS for shape in SHAPES],
    'cloth.vert': _GAPS,
    'cloth_color.frag': [
        {**DAYLIGHT_DEFINES, **fabric} for fabric in (*FABRIC_DEFINES.values(), PRINT_DEFINES)],
    'cloth_depth.vert': _GAPS,
    'cloth_values.frag': _NORMALS,
    'nothing.frag': [{}],
    'screen.vert': [{}],
}


def test_every_shader_is_looked_at():
    """A new shader would be tried on one driver only."""
    assert {path.name for path in (shader_directory() / 'camera').iterdir()} == set(_FORMS)


@pytest.mark.parametrize(
    ('name', 'defines'), [(name, defines) for name, forms in _FORMS.items() for defines in forms])
def test_glslang_accepts_the_shader(tmp_path: Path, name: str, defines: dict):
    """The picture would be drawn on one driver's leniency only."""
    assert_accepted(tmp_path, f'camera/{name}', defines)
