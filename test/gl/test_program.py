# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Programs and buffers: a tiny kernel through the whole way, and errors that can be read."""

from pathlib import Path

from cloth_sim_ros.gl import shader_source
from cloth_sim_ros.gl.buffer import Buffer
from cloth_sim_ros.gl.buffer import shader_writes_visible
from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.errors import ShaderError
from cloth_sim_ros.gl.program import explain
from cloth_sim_ros.gl.program import Program
from cloth_sim_ros.gl.shader_source import ShaderSource
import numpy as np
import pytest

_DOUBLE = """#version 430 core
layout(local_size_x = 64) in;
layout(std430, binding = 1) buffer Values { vec4 values[]; };
layout(binding = 0) uniform samplerBuffer values_in;
uniform float factor;
void main() {
    uint i = gl_GlobalInvocationID.x;
    values[i] = factor * texelFetch(values_in, int(i));
}
"""


@pytest.fixture
def shaders(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a context and a shader folder with one kernel."""
    Context()
    (tmp_path / 'double.comp').write_text(_DOUBLE)
    monkeypatch.setattr(shader_source, 'shader_directory', lambda: tmp_path)
    return tmp_path


def test_a_kernel_reads_a_texture_and_writes_storage(shaders: Path):
    """Nothing could be computed, or the wrong buffer would be read."""
    given = np.arange(512, dtype=np.float32)
    source, target = Buffer(given), Buffer(given.nbytes)
    program = Program(ShaderSource('double.comp'))
    program.use()
    program.set_float('factor', 2.0)
    source.bind_texture(0)
    target.bind_storage(1)
    program.dispatch(2)
    shader_writes_visible()
    result = np.empty_like(given)
    target.read_into(result)
    np.testing.assert_array_equal(result, 2.0 * given)


def test_part_of_a_buffer_is_written(shaders: Path):
    """Pinning one node would overwrite another."""
    buffer = Buffer(np.zeros(8, dtype=np.float32))
    buffer.write(np.ones(2, dtype=np.float32), offset=12)
    result = np.empty(8, dtype=np.float32)
    buffer.read_into(result)
    np.testing.assert_array_equal(result, [0, 0, 0, 1, 1, 0, 0, 0])


def test_a_compile_error_shows_file_line_and_text(shaders: Path):
    """The user would have to guess which line the driver means."""
    (shaders / 'wrong.comp').write_text(
        '#version 430 core\nlayout(local_size_x = 1) in;\nvoid main() {\n    nothing();\n}\n')
    with pytest.raises(ShaderError, match=r'wrong\.comp:4: nothing\(\);'):
        Program(ShaderSource('wrong.comp'))


@pytest.mark.parametrize('log', [
    '0:3(5): error: no function', '0(3) : error C1115: unable', "ERROR: 0:3: 'nothing'"])
def test_every_vendors_error_form_is_read(shaders: Path, log: str):
    """On another driver the line would not be shown."""
    assert 'double.comp:3' in explain(ShaderSource('double.comp'), log)


def test_too_many_workgroups_are_refused(shaders: Path):
    """A device would do nothing at all, silently."""
    program = Program(ShaderSource('double.comp'))
    program.use()
    with pytest.raises(ShaderError, match='70000 x 1 workgroups, at most 65535'):
        program.dispatch(70000)
