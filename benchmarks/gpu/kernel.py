# SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
# SPDX-License-Identifier: Apache-2.0

"""Small compute shaders of the suite itself, for what a device can do at best."""

from cloth_sim_ros.gl.libraries import GL

LOCAL = 64
# Adds a number to each float of a buffer.
ADD = f"""#version 430 core
layout(local_size_x = {LOCAL}) in;
layout(std430, binding = 0) buffer Values {{ float values[]; }};
uniform float term;
void main() {{ values[gl_GlobalInvocationID.x] += term; }}
"""
# Copies 32 bytes an invocation, as position and velocity of a node.
COPY = f"""#version 430 core
layout(local_size_x = {LOCAL}, local_size_y = 2) in;
layout(std430, binding = 0) readonly buffer Source {{ vec4 source[]; }};
layout(std430, binding = 1) writeonly buffer Target {{ vec4 target[]; }};
void main() {{
    uint i = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * {4 * LOCAL}
        + gl_LocalInvocationIndex;
    target[i] = source[i];
    target[i + {2 * LOCAL}] = source[i + {2 * LOCAL}];
}}
"""


def compiled(source: str) -> int:
    """Return the name of a linked program."""
    shader = GL.glCreateShader(GL.GL_COMPUTE_SHADER)
    GL.glShaderSource(shader, source)
    GL.glCompileShader(shader)
    program = int(GL.glCreateProgram())
    GL.glAttachShader(program, shader)
    GL.glLinkProgram(program)
    GL.glDeleteShader(shader)
    return program
