# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A render program: a vertex and a fragment shader that draw strips of triangles."""

from collections.abc import Mapping

from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.linked_program import LinkedProgram
from cloth_sim_ros.gl.shader_source import ShaderSource


class RenderProgram(LinkedProgram):
    """
    Vertex and fragment shader ``name`` on the device.

    Vertices have no attributes: the shader makes them from their number and reads buffers.

    :param vertex: file of the vertex shader in the shader folder
    :param fragment: file of the fragment shader
    :param defines: what to #define in both
    :raises ShaderError: with file, line and text of what the compiler refuses
    """

    def __init__(
            self, vertex: str, fragment: str, defines: Mapping[str, object] | None = None) -> None:
        """Compile and link both."""
        super().__init__({
            GL.GL_VERTEX_SHADER: ShaderSource(vertex, defines),
            GL.GL_FRAGMENT_SHADER: ShaderSource(fragment, defines)})
        # A core profile draws nothing without a vertex array, be it empty.
        self._vertex_array = int(GL.glGenVertexArrays(1))

    def draw_strips(self, vertices: int, strips: int = 1) -> None:
        """Draw ``strips`` triangle strips of ``vertices`` each, with the program in use."""
        GL.glBindVertexArray(self._vertex_array)
        GL.glDrawArraysInstanced(GL.GL_TRIANGLE_STRIP, 0, vertices, strips)
