# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Programs are used again by whoever asks for the same shaders in the same context."""

from collections.abc import Iterator
from pathlib import Path

from cloth_sim_ros.gl import program_pool
from cloth_sim_ros.gl import shader_source
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.shader_source import ShaderSource
import numpy as np
import pytest

SHADER = """#version 430 core
layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Out { float out_values[]; };
uniform float one;
uniform float several[3];
uniform vec2 pair;
uniform vec3 vectors[2];
uniform int number;
uniform ivec4 numbers[2];
uniform uint positive;
uniform mat4 matrix;
void main() {
    out_values[0] = one * SCALE;
    out_values[1] = several[0] + several[1] + several[2];
    out_values[2] = pair.x + pair.y;
    out_values[3] = vectors[0].x + vectors[1].z;
    out_values[4] = float(number);
    out_values[5] = float(numbers[0].x + numbers[1].w);
    out_values[6] = float(positive);
    out_values[7] = matrix[0][0] + matrix[3][3];
}
"""


@pytest.fixture
def context(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Context]:
    """Return a context, with a shader that has uniforms of every kind."""
    (tmp_path / 'sums.comp').write_text(SHADER)
    monkeypatch.setattr(shader_source, 'shader_directory', lambda: tmp_path)
    context = Context(single_thread=True)
    yield context
    context.close()


def program(scale: float = 1.0) -> Program:
    """Return the program of a scale."""
    return Program(ShaderSource('sums.comp', {'SCALE': f'{scale:.1f}'}))


def name_of(program: Program) -> int:
    """Return the name of a program in GL."""
    program.use()
    return int(GL.glGetIntegerv(GL.GL_CURRENT_PROGRAM))


def sums(program: Program) -> list[float]:
    """Return the output of the program for its uniforms."""
    out = Buffer(np.full(8, -1.0, dtype=np.float32))
    out.bind_storage(0)
    program.use()
    program.dispatch(1)
    shader_writes_visible()
    values = np.empty(8, dtype=np.float32)
    out.read_into(values)
    out.delete()
    return values.tolist()


def fill(program: Program) -> None:
    """Set every uniform."""
    program.use()
    program.set_float('one', 2.0)
    program.set_floats('several', [1.0, 2.0, 3.0])
    program.set_pair('pair', (1.0, 2.0))
    program.set_vectors('vectors', [(1.0, 2.0, 3.0), (4.0, 5.0, 6.0)])
    program.set_int('number', 7)
    program.set_int_vectors('numbers', np.array([[1, 2, 3, 4], [5, 6, 7, 8]]))
    GL.glUniform1ui(GL.glGetUniformLocation(name_of(program), 'positive'), 9)
    program.set_matrix('matrix', np.eye(4))


def test_the_next_gets_a_program_as_if_it_were_new(context: Context):
    """A second simulation would compile again, or have a stiffness of the first."""
    first = program()
    fill(first)
    assert sums(first) == [2.0, 6.0, 3.0, 7.0, 7.0, 9.0, 9.0, 2.0]
    first.delete()
    second = program()
    assert name_of(second) == name_of(first)
    assert second.dispatches == 0
    assert sums(second) == [0.0] * 8
    fill(second)
    assert sums(second) == [2.0, 6.0, 3.0, 7.0, 7.0, 9.0, 9.0, 2.0]


def test_a_program_that_is_forgotten_is_used_again(context: Context):
    """A long process would keep the programs of all its simulations."""
    first = program()
    name = name_of(first)
    del first
    assert name_of(program()) == name


def test_a_program_in_use_is_nobody_elses(context: Context):
    """Two simulations in one context would set each other's uniforms."""
    first, second = program(), program()
    assert name_of(first) != name_of(second)


def test_other_choices_are_another_program(context: Context):
    """A scene would be simulated with the choices of another one."""
    first = program()
    first.delete()
    second = program(2.0)
    fill(second)
    assert sums(second)[0] == 4.0


def test_another_context_has_programs_of_its_own(context: Context):
    """A program would be used where it does not exist."""
    first = program()
    first.delete()
    other = Context(single_thread=True)
    second = program()
    fill(second)
    assert sums(second)[0] == 2.0
    other.close()
    context.make_current()
    assert name_of(program()) == name_of(first)


def test_those_that_idle_longest_are_dropped(context: Context, monkeypatch: pytest.MonkeyPatch):
    """A study of a thousand scenes would keep the programs of all of them."""
    monkeypatch.setattr(program_pool, '_MOST_IDLE', 2)
    made = [program(float(number)) for number in range(4)]
    names = [name_of(each) for each in made]
    GL.glUseProgram(0)
    for each in made:
        each.delete()
    program(9.0)
    assert [bool(GL.glIsProgram(name)) for name in names] == [False, False, True, True]
