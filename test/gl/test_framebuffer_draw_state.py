# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""What is nearer hides what is farther, unless asked otherwise."""

from cloth_sim_ros.gl import framebuffer as gl_framebuffer
from cloth_sim_ros.gl import shader_source
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.framebuffer import Framebuffer
from cloth_sim_ros.gl.program import RenderProgram
import pytest

_VERTEX = """#version 430 core
uniform float depth;
void main() {
    gl_Position = vec4(4.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 2.0, depth, 1.0);
}
"""
_FRAGMENT = """#version 430 core
uniform vec2 grey_and_opacity;
out vec4 color;
void main() {
    color = vec4(vec3(grey_and_opacity.x), grey_and_opacity.y);
}
"""
NEAR, MIDDLE, FAR = -0.5, 0.0, 0.5


@pytest.fixture
def drawn(tmp_path, monkeypatch):
    """Return a function that fills the picture at a depth, and returns the grey it has then."""
    context = Context()
    (tmp_path / 'fill.vert').write_text(_VERTEX)
    (tmp_path / 'fill.frag').write_text(_FRAGMENT)
    monkeypatch.setattr(shader_source, 'shader_directory', lambda: tmp_path)
    framebuffer = Framebuffer(2, 2)
    framebuffer.begin((0.0, 0.0, 0.0))
    program = RenderProgram('fill.vert', 'fill.frag')
    program.use()

    def draw(depth, grey, opacity=1.0):
        # Reading resolves the picture and directs drawing elsewhere: look at the end only.
        program.set_float('depth', depth)
        program.set_pair('grey_and_opacity', (grey, opacity))
        program.draw_strips(4)
        return lambda: int(framebuffer.read()[0, 0, 0])

    yield draw
    context.close()


def test_the_nearest_is_seen(drawn):
    """The far side of a cloth would be drawn over the near one."""
    gl_framebuffer.draw_nearest()
    drawn(MIDDLE, 0.2)
    drawn(NEAR, 0.6)
    assert drawn(FAR, 1.0)() == 153


def test_what_does_not_hide_is_covered_by_what_comes(drawn):
    """A pin would cut a hole into the next one."""
    gl_framebuffer.draw_nearest(hides=False)
    drawn(NEAR, 0.2)
    assert drawn(FAR, 0.6)() == 153


def test_what_is_hidden_can_be_drawn_alone(drawn):
    """A pin behind the cloth would look like one in front of it."""
    gl_framebuffer.draw_nearest()
    drawn(MIDDLE, 0.2)
    gl_framebuffer.draw_hidden()
    drawn(NEAR, 1.0)
    assert drawn(FAR, 0.6)() == 153


def test_over_all_means_over_all(drawn):
    """The floor would hide the cloth, or be hidden by its own shadow."""
    gl_framebuffer.draw_over_all()
    drawn(NEAR, 0.2)
    drawn(FAR, 0.6)
    gl_framebuffer.draw_nearest()
    assert drawn(FAR, 1.0)() == 255


def test_opacity_lets_through_what_is_there(drawn):
    """A faint ball would be as strong as any."""
    gl_framebuffer.draw_over_all()
    gl_framebuffer.blend_by_opacity()
    drawn(MIDDLE, 1.0)
    assert drawn(MIDDLE, 0.0, 0.2)() == 204


@pytest.mark.parametrize(('is_on', 'grey'), [(True, 0), (False, 255)])
def test_one_side_can_be_left_out(drawn, is_on, grey):
    """The inside of an arrow would show through its outside."""
    gl_framebuffer.draw_over_all()
    # The strip runs counter-clockwise.
    gl_framebuffer.draw_clockwise_only(is_on)
    assert drawn(MIDDLE, 1.0)() == grey
