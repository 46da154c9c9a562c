// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// End a substep of the paper's adaptive scheme, whose velocities the sweeps have settled: move the
// nodes.

#include "lattice.glsl"
#include "state_in.glsl"
#include "low_parts.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = POSITION_OUT) writeonly buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) readonly buffer Velocity { vec4 velocity_out[]; };

uniform float substep;  // [s]

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 x = load_position(index);
    position_out[index] = vec4(
        changed_position(index, x.xyz, substep * velocity_out[index].xyz), x.w);
}
