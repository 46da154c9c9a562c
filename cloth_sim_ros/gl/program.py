# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""A compute program: compile, set uniforms, dispatch."""

from cloth_sim_ros.gl import quick_calls
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.inventory import note_program
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.linked_program import LinkedProgram
from cloth_sim_ros.gl.quick_calls import Call
from cloth_sim_ros.gl.shader_source import ShaderSource

_MOST_GROUPS = 65535


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
        if max(groups_x, groups_y) > _MOST_GROUPS:
            raise ShaderError(
                f'{self.name} needs {groups_x} x {groups_y} workgroups, at most {_MOST_GROUPS} '
                'are allowed per side: use fewer nodes')
        self.dispatches += 1
        quick_calls.dispatch(groups_x, groups_y, 1)

    def dispatch_indirect(self, offset: int) -> None:
        """Run the program in use on the workgroups that stand at ``offset`` [bytes]."""
        self.dispatches += 1
        quick_calls.dispatch_indirect(offset)

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
