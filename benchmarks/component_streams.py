# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""
Whether llvmpipe gains by a buffer for each component, on a pass that gathers like the springs'.

Each node adds a term of its 12 neighbours and stores the result, with its components in one buffer
or in three, in blocks of 4 x 4 nodes or in columns of 16, so that the lanes of a vector read
consecutive numbers.

For example:
  LP_NUM_THREADS=0 python benchmarks/component_streams.py
"""

import argparse
from dataclasses import dataclass
import statistics
import time

from cloth_sim_ros.gl.context import Context
from cloth_sim_ros.gl.libraries import GL
import numpy as np

_SHADER = """
#version 430 core
layout(local_size_x = 8) in;
uniform int cols;
#if STREAMS == 1
layout(binding = 0) uniform samplerBuffer from;
layout(std430, binding = 1) buffer To { vec4 to[]; };
vec3 load(int i) { return texelFetch(from, i).xyz; }
void store(int i, vec3 value) { to[i].xyz = value; }
#else
layout(binding = 0) uniform samplerBuffer from_x;
layout(binding = 1) uniform samplerBuffer from_y;
layout(binding = 2) uniform samplerBuffer from_z;
layout(std430, binding = 1) buffer ToX { float to_x[]; };
layout(std430, binding = 2) buffer ToY { float to_y[]; };
layout(std430, binding = 3) buffer ToZ { float to_z[]; };
vec3 load(int i) {
    return vec3(texelFetch(from_x, i).x, texelFetch(from_y, i).x, texelFetch(from_z, i).x);
}
void store(int i, vec3 value) {
    to_x[i] = value.x;
    to_y[i] = value.y;
    to_z[i] = value.z;
}
#endif
vec3 tile[HIGH + 4][WIDE + 4];
vec3 term(vec3 d) { return d * (1.0 - 0.01 * inversesqrt(dot(d, d) + 1e-9)); }
void main() {
    int group = int(gl_GlobalInvocationID.x);
    int first = group / (cols / WIDE) * HIGH * (cols + 4) + group % (cols / WIDE) * WIDE;
    for (int row = 0; row < HIGH + 4; ++row) {
        for (int col = 0; col < WIDE + 4; ++col) {
            // Neighbours are two away along rows and columns, and one along diagonals.
            int beyond = max(2 - row, row - HIGH - 1), beside = max(2 - col, col - WIDE - 1);
            if (beyond <= 0 || beside <= 0 || beyond + beside <= 2) {
                tile[row][col] = load(first + row * (cols + 4) + col);
            }
        }
    }
    for (int row = 2; row < HIGH + 2; ++row) {
        for (int col = 2; col < WIDE + 2; ++col) {
            vec3 x = tile[row][col], sum = vec3(0.0);
            for (int side = -1; side <= 1; side += 2) {
                sum += term(tile[row][col + side] - x) + term(tile[row + side][col] - x)
                    + term(tile[row + side][col + side] - x)
                    + term(tile[row + side][col - side] - x)
                    + term(tile[row][col + 2 * side] - x) + term(tile[row + 2 * side][col] - x);
            }
            store(first + row * (cols + 4) + col, x + 1e-3 * sum);
        }
    }
}
"""
# Name, buffers, and nodes of an invocation along a column and along a row.
_LAYOUTS = (
    ('one buffer, blocks of 4 x 4', 1, 4, 4), ('three buffers, blocks of 4 x 4', 3, 4, 4),
    ('one buffer, columns of 16', 1, 16, 1), ('three buffers, columns of 16', 3, 16, 1))


@dataclass(frozen=True)
class _Pass:
    program: int
    textures: list[int]
    outputs: list[int]
    groups: int

    def time(self, count: int) -> float:
        """Return the processor time of a pass [s]."""
        GL.glUseProgram(self.program)
        for unit, texture in enumerate(self.textures):
            GL.glActiveTexture(GL.GL_TEXTURE0 + unit)
            GL.glBindTexture(GL.GL_TEXTURE_BUFFER, texture)
        for binding, buffer in enumerate(self.outputs, 1):
            GL.glBindBufferBase(GL.GL_SHADER_STORAGE_BUFFER, binding, buffer)
        GL.glFinish()
        begin = time.process_time()
        for _ in range(count):
            GL.glDispatchCompute(self.groups, 1, 1)
        GL.glFinish()
        return (time.process_time() - begin) / count


def _make(size: int, streams: int, high: int, wide: int) -> _Pass:
    defines = f'#define STREAMS {streams}\n#define HIGH {high}\n#define WIDE {wide}\n'
    version, text = _SHADER.strip().split('\n', 1)
    shader = GL.glCreateShader(GL.GL_COMPUTE_SHADER)
    GL.glShaderSource(shader, f'{version}\n{defines}{text}')
    GL.glCompileShader(shader)
    program = GL.glCreateProgram()
    GL.glAttachShader(program, shader)
    GL.glLinkProgram(program)
    assert GL.glGetProgramiv(program, GL.GL_LINK_STATUS), GL.glGetShaderInfoLog(shader)
    GL.glUseProgram(program)
    GL.glUniform1i(GL.glGetUniformLocation(program, 'cols'), size)
    floats = (size + 4) ** 2 * (4 if streams == 1 else 1)
    inputs, outputs = (GL.glGenBuffers(streams) for _ in range(2))
    inputs, outputs = np.atleast_1d(inputs).tolist(), np.atleast_1d(outputs).tolist()
    values = np.random.default_rng(1).random(floats, dtype=np.float32)
    textures = []
    for buffer in inputs + outputs:
        GL.glBindBuffer(GL.GL_SHADER_STORAGE_BUFFER, buffer)
        GL.glBufferData(GL.GL_SHADER_STORAGE_BUFFER, values.nbytes, values, GL.GL_DYNAMIC_COPY)
    for buffer in inputs:
        textures.append(int(GL.glGenTextures(1)))
        GL.glBindTexture(GL.GL_TEXTURE_BUFFER, textures[-1])
        GL.glTexBuffer(
            GL.GL_TEXTURE_BUFFER, GL.GL_RGBA32F if streams == 1 else GL.GL_R32F, buffer)
    return _Pass(program, textures, outputs, size * size // (8 * high * wide))


def main() -> None:
    """Print the time of a node in each layout, and its speed over that of the first."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--sizes', type=int, nargs='+', default=[128, 512], metavar='N')
    parser.add_argument('--rounds', type=int, default=9)
    arguments = parser.parse_args()
    context = Context()
    for size in arguments.sizes:
        passes = [_make(size, *layout) for _, *layout in _LAYOUTS]
        count = max(1, 400_000 // size**2)
        times = [[one.time(count) for one in passes] for _ in range(1 + arguments.rounds)][1:]
        print(f'{size} x {size}')
        for number, (name, *_) in enumerate(_LAYOUTS):
            ratios = sorted(turn[0] / turn[number] for turn in times)
            nanoseconds = 1e9 * statistics.median(turn[number] for turn in times) / size**2
            print(f'  {name:32} {nanoseconds:6.1f} ns a node, {statistics.median(ratios):.2f} x '
                  f'({ratios[0]:.2f} to {ratios[-1]:.2f})', flush=True)
    context.close()


if __name__ == '__main__':
    main()
