# Copyright 2026 the cloth_sim_ros authors
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""A compute program: compile, set uniforms, dispatch."""

from collections.abc import Sequence
import re

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.inventory import note_program
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.shader_source import ShaderSource
import numpy as np
from OpenGL import GL

# Mesa: "0:12(3): error", NVIDIA: "0(12) : error", others: "ERROR: 0:12:".
_LINE = re.compile(r'\b0[:(](\d+)[):(]')
_MOST_GROUPS = 65535


class Program:
    """
    A compute shader on the device.

    ``dispatches`` counts its runs, those among them that the device may have left out.

    :raises ShaderError: with file, line and text of what the compiler refuses
    """

    def __init__(self, source: ShaderSource) -> None:
        """Compile and link ``source``."""
        self.name = source.name
        self.source = source
        self.dispatches = 0
        shader = GL.glCreateShader(GL.GL_COMPUTE_SHADER)
        GL.glShaderSource(shader, source.text)
        GL.glCompileShader(shader)
        if not GL.glGetShaderiv(shader, GL.GL_COMPILE_STATUS):
            log = GL.glGetShaderInfoLog(shader)
            GL.glDeleteShader(shader)
            raise ShaderError(explain(source, _text(log)))
        self._program = GL.glCreateProgram()
        GL.glAttachShader(self._program, shader)
        GL.glLinkProgram(self._program)
        GL.glDeleteShader(shader)
        if not GL.glGetProgramiv(self._program, GL.GL_LINK_STATUS):
            raise ShaderError(explain(source, _text(GL.glGetProgramInfoLog(self._program))))
        self._locations: dict[str, int] = {}
        note_program(self)

    def use(self) -> None:
        """Make this the program that ``set`` and ``dispatch`` act on."""
        quick_calls.use_program(self._program)

    def set_float(self, name: str, value: float) -> None:
        """Set a float uniform of the program in use."""
        quick_calls.set_uniform_float(self._location(name), value)

    def set_int(self, name: str, value: int) -> None:
        """Set an int uniform of the program in use."""
        quick_calls.set_uniform_int(self._location(name), value)

    def set_floats(self, name: str, values: Sequence[float]) -> None:
        """Set the first floats of an array uniform of the program in use."""
        flat = np.ascontiguousarray(values, dtype=np.float32)
        GL.glUniform1fv(self._location(name), len(flat), flat)

    def set_vectors(self, name: str, vectors: Sequence[Sequence[float]] | np.ndarray) -> None:
        """Set a vec3 uniform, or the first of an array of them, of the program in use."""
        flat = np.ascontiguousarray(vectors, dtype=np.float32).reshape(-1, 3)
        GL.glUniform3fv(self._location(name), len(flat), flat)

    def set_int_vectors(self, name: str, vectors: np.ndarray) -> None:
        """Set the first of an array of ivec2 or ivec4 uniforms of the program in use."""
        flat = np.ascontiguousarray(vectors, dtype=np.int32)
        setter = {2: GL.glUniform2iv, 4: GL.glUniform4iv}[flat.shape[1]]
        setter(self._location(name), len(flat), flat)

    def dispatch(self, groups_x: int, groups_y: int = 1) -> None:
        """Run the program in use on ``groups_x`` x ``groups_y`` workgroups."""
        if max(groups_x, groups_y) > _MOST_GROUPS:
            raise ShaderError(
                f'{self.name} needs {groups_x} x {groups_y} workgroups, at most {_MOST_GROUPS} '
                'are allowed a side: use fewer nodes')
        self.dispatches += 1
        quick_calls.dispatch(groups_x, groups_y, 1)

    def indirect_calls(self, offset: int, **uniforms: int) -> list[Call]:
        """
        Return the calls that run the program on the workgroups that stand at ``offset`` [bytes].

        Whoever makes them tells ``submitted``.

        :param uniforms: int uniforms to set before
        """
        return [
            (quick_calls.use_program, (self._program,)),
            *((quick_calls.set_uniform_int, (self._location(name), value))
              for name, value in uniforms.items()),
            (quick_calls.dispatch_indirect, (offset,))]

    def submitted(self, count: int) -> None:
        """Count ``count`` times that the ``indirect_calls`` were made."""
        self.dispatches += count

    def _location(self, name: str) -> int:
        if name not in self._locations:
            self._locations[name] = GL.glGetUniformLocation(self._program, name)
        # -1 means the shader doesn't use it, and GL ignores what is set there.
        return self._locations[name]


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
