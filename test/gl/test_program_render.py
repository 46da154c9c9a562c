# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Vertex and fragment shaders: strips without attributes, and errors that can be read."""

from cloth_sim_ros.gl import shader_source
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.framebuffer import Framebuffer
from cloth_sim_ros.gl.program import RenderProgram
import numpy as np
import pytest

_VERTEX = """#version 430 core
uniform mat4 place;
void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) + vec2(2 * gl_InstanceID, 0);
    gl_Position = place * vec4(corner, 0.0, 1.0);
}
"""
_FRAGMENT = """#version 430 core
uniform vec2 red_and_green;
out vec4 color;
void main() {
    color = vec4(red_and_green, BLUE, 1.0);
}
"""


@pytest.fixture
def shaders(tmp_path, monkeypatch):
    """Give a context and a shader folder with a program in it."""
    context = Context()
    (tmp_path / 'square.vert').write_text(_VERTEX)
    (tmp_path / 'plain.frag').write_text(_FRAGMENT)
    monkeypatch.setattr(shader_source, 'shader_directory', lambda: tmp_path)
    yield tmp_path
    context.close()


def test_strips_are_drawn_where_the_matrix_puts_them(shaders):
    """The cloth would be drawn elsewhere: transposed, mirrored, or only its first strip."""
    framebuffer = Framebuffer(8, 4)
    framebuffer.begin((0.0, 0.0, 0.0))
    program = RenderProgram('square.vert', 'plain.frag', {'BLUE': '0.2'})
    program.use()
    # Units of two pixels, from the lower left corner of the picture.
    program.set_matrix('place', np.array([
        [0.5, 0.0, 0.0, -1.0], [0.0, 1.0, 0.0, -1.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]))
    program.set_pair('red_and_green', (1.0, 0.6))
    program.draw_strips(4, 2)
    image = framebuffer.read()
    expected = np.zeros((4, 8), bool)
    expected[2:, 0:2] = expected[2:, 4:6] = True
    np.testing.assert_array_equal((image == (255, 153, 51)).all(axis=-1), expected)
    assert (image[~expected] == 0).all()


@pytest.mark.parametrize('stage', ['square.vert', 'plain.frag'])
def test_a_compile_error_names_the_stage_and_its_line(shaders, stage):
    """The user would have to guess which of the two shaders the driver means."""
    (shaders / stage).write_text('#version 430 core\nvoid main() {\n    nothing();\n}\n')
    with pytest.raises(ShaderError, match=rf'{stage}:3: nothing\(\);'):
        RenderProgram('square.vert', 'plain.frag', {'BLUE': '0.2'})


def test_stages_that_do_not_fit_are_refused(shaders):
    """A picture would stay empty, without a word."""
    (shaders / 'plain.frag').write_text(
        '#version 430 core\nin vec3 normal;\nout vec4 color;\n'
        'void main() {\n    color = vec4(normal, 1.0);\n}\n')
    with pytest.raises(ShaderError, match='plain.frag'):
        RenderProgram('square.vert', 'plain.frag')
