# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Compute and render programs: compile, link, set uniforms, dispatch and draw."""

from collections.abc import Mapping
from collections.abc import Sequence
import re

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.inventory import note_program
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.program_pool import current_pool
from cloth_sim_ros.gl.program_pool import PooledProgram
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.shader_source import ShaderSource
import numpy as np

# Mesa: "0:12(3): error", NVIDIA: "0(12) : error", others: "ERROR: 0:12:".
_LINE = re.compile(r'\b0[:(](\d+)[):(]')

_INT_VECTORS = {2: quick_calls.set_uniform_ivec2s, 4: quick_calls.set_uniform_ivec4s}


class LinkedProgram:
    """
    Shaders on the device that work together.

    :param stages: the source of each stage, by its GL name
    :raises ShaderError: with file, line and text of what the compiler refuses
    """

    def __init__(self, stages: Mapping[int, ShaderSource]) -> None:
        """Compile and link ``stages``."""
        self.name = ' and '.join(source.name for source in stages.values())
        self._texts = tuple(source.text for source in stages.values())
        self._lent: PooledProgram | None = None
        self._pool = current_pool()
        if self._pool is not None:
            self._lent = self._pool.take(self._texts)
        if self._lent is None:
            self._lent = PooledProgram(_linked(stages))
        self._program = self._lent.name
        self._locations = self._lent.locations
        # Values last set, by name of the array: most are the same in every frame.
        self._arrays: dict[str, bytes] = {}

    def delete(self) -> None:
        """Return the program to the pool; it must not be used here any more."""
        lent, self._lent = self._lent, None
        if lent is None:
            return
        if self._pool is None:
            GL.glDeleteProgram(lent.name)
        else:
            self._pool.give_back(self._texts, lent)

    def __del__(self) -> None:
        """Leave it to the next if nobody has; whichever context is current then, or none."""
        if self._pool is not None:
            self.delete()

    def use(self) -> None:
        """Make this the program that later calls act on."""
        quick_calls.use_program(self._program)

    def set_float(self, name: str, value: float) -> None:
        """Set a float uniform of the program in use."""
        quick_calls.set_uniform_float(self._location(name), value)

    def set_int(self, name: str, value: int) -> None:
        """Set an int uniform of the program in use."""
        quick_calls.set_uniform_int(self._location(name), value)

    def set_int_anywhere(self, name: str, value: int) -> None:
        """Set an int uniform, whatever program is in use."""
        quick_calls.set_program_int(self._program, self._location(name), value)

    def set_floats(self, name: str, values: Sequence[float] | np.ndarray) -> None:
        """Set the first floats of an array uniform of the program in use."""
        flat = np.ascontiguousarray(values, dtype=np.float32)
        if self._changed(name, flat):
            quick_calls.set_uniform_floats(self._location(name), len(flat), flat.ctypes.data)

    def set_pair(self, name: str, values: Sequence[float]) -> None:
        """Set a vec2 uniform of the program in use."""
        GL.glUniform2f(self._location(name), *values)

    def set_vectors(
            self, name: str,
            vectors: Sequence[float] | Sequence[Sequence[float]] | np.ndarray) -> None:
        """Set a vec3 uniform, or the first of an array of them, of the program in use."""
        flat = np.ascontiguousarray(vectors, dtype=np.float32).reshape(-1, 3)
        if self._changed(name, flat):
            quick_calls.set_uniform_vec3s(self._location(name), len(flat), flat.ctypes.data)

    def set_int_vectors(self, name: str, vectors: np.ndarray) -> None:
        """Set the first of an array of ivec2 or ivec4 uniforms of the program in use."""
        flat = np.ascontiguousarray(vectors, dtype=np.int32)
        setter = _INT_VECTORS[flat.shape[1]]
        setter(self._location(name), len(flat), flat.ctypes.data)

    def set_matrix(self, name: str, matrix: np.ndarray) -> None:
        """Set a mat4 uniform, which acts on columns, of the program in use."""
        flat = np.ascontiguousarray(matrix, dtype=np.float32)
        GL.glUniformMatrix4fv(self._location(name), 1, GL.GL_TRUE, flat)

    def _changed(self, name: str, values: np.ndarray) -> bool:
        """Return whether ``values`` differ from those set last for ``name``, and store them."""
        data = values.tobytes()
        if self._arrays.get(name) == data:
            return False
        self._arrays[name] = data
        return True

    def _location(self, name: str) -> int:
        if name not in self._locations:
            self._locations[name] = GL.glGetUniformLocation(self._program, name)
        # -1 means the shader doesn't use it, and GL ignores what is set there.
        return self._locations[name]


def _linked(stages: Mapping[int, ShaderSource]) -> int:
    shaders = [_compiled(stage, source) for stage, source in stages.items()]
    program = GL.glCreateProgram()
    for shader in shaders:
        GL.glAttachShader(program, shader)
    GL.glLinkProgram(program)
    for shader in shaders:
        GL.glDeleteShader(shader)
    if not GL.glGetProgramiv(program, GL.GL_LINK_STATUS):
        last = list(stages.values())[-1]
        raise ShaderError(explain(last, _text(GL.glGetProgramInfoLog(program))))
    return program


def _compiled(stage: int, source: ShaderSource) -> int:
    shader = GL.glCreateShader(stage)
    GL.glShaderSource(shader, source.text)
    GL.glCompileShader(shader)
    if not GL.glGetShaderiv(shader, GL.GL_COMPILE_STATUS):
        log = GL.glGetShaderInfoLog(shader)
        GL.glDeleteShader(shader)
        raise ShaderError(explain(source, _text(log)))
    return shader


def explain(source: ShaderSource, log: str) -> str:
    """Return the compiler's ``log`` with the lines it speaks of."""
    lines = [f'{source.name} does not compile:']
    for entry in log.strip().splitlines():
        lines.append(f'  {entry}')
        found = _LINE.search(entry)
        if found:
            lines.append(f'    {source.origin(int(found[1]))}')
    return '\n'.join(lines)


def _text(log: bytes | str) -> str:
    return log.decode(errors='replace') if isinstance(log, bytes) else log


# A compute program: compile, set uniforms, dispatch.

MOST_GROUPS = 65535


class Program(LinkedProgram):
    """
    A compute shader on the device.

    ``dispatches`` counts its runs, those among them that the device may have left out.

    :raises ShaderError: with file, line and text of what the compiler refuses
    """

    def __init__(self, source: ShaderSource) -> None:
        """Compile and link ``source``."""
        super().__init__({GL.GL_COMPUTE_SHADER: source})
        self.source = source
        self.dispatches = 0
        note_program(self)

    def dispatch(self, groups_x: int, groups_y: int = 1) -> None:
        """Run the program in use on ``groups_x`` x ``groups_y`` workgroups."""
        self._check_groups(groups_x, groups_y)
        self.dispatches += 1
        quick_calls.dispatch(groups_x, groups_y, 1)

    def dispatch_indirect(self, offset: int) -> None:
        """Run the program in use on the workgroups that stand at ``offset`` [bytes]."""
        self.dispatches += 1
        quick_calls.dispatch_indirect(offset)

    def calls(self, groups_x: int, groups_y: int, **uniforms: int) -> list[Call]:
        """
        Return the calls that run the program on ``groups_x`` x ``groups_y`` workgroups.

        Whoever makes them tells ``submitted``.

        :param uniforms: int uniforms to set before
        """
        self._check_groups(groups_x, groups_y)
        return [*self._calls_before(uniforms), (quick_calls.dispatch, (groups_x, groups_y, 1))]

    def indirect_calls(self, offset: int, **uniforms: int) -> list[Call]:
        """Return the same for the workgroups that stand at ``offset`` [bytes]."""
        return [*self._calls_before(uniforms), (quick_calls.dispatch_indirect, (offset,))]

    def submitted(self, count: int) -> None:
        """Count ``count`` times that ``calls`` or ``indirect_calls`` were made."""
        self.dispatches += count

    def _calls_before(self, uniforms: Mapping[str, int]) -> list[Call]:
        return [
            (quick_calls.use_program, (self._program,)),
            *((quick_calls.set_uniform_int, (self._location(name), value))
              for name, value in uniforms.items())]

    def _check_groups(self, groups_x: int, groups_y: int) -> None:
        if groups_x > MOST_GROUPS or groups_y > MOST_GROUPS:
            raise ShaderError(
                f'{self.name} needs {groups_x} x {groups_y} workgroups, at most {MOST_GROUPS} '
                'are allowed per side: use fewer nodes')


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

    def draw_triangles(self, vertices: int, rows: int) -> None:
        """Draw ``rows`` of triangles, of ``vertices`` each, with the program in use."""
        GL.glBindVertexArray(self._vertex_array)
        GL.glDrawArraysInstanced(GL.GL_TRIANGLES, 0, vertices, rows)
