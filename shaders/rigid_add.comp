// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add a rigid motion to a substep that has been made: to the velocities, and to the positions for
// the length of the substep.

#include "lattice.glsl"
#include "state_in.glsl"
#include "state_out.glsl"
#include "low_parts.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;  // [s]
uniform vec3 centre;    // [m] that it turns about
uniform vec3 velocity;  // [m/s]
uniform vec3 turn;      // [1/s]

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 v = load_velocity(index);
    vec4 x = load_position(index);
    vec3 change = v.w > 0.0
        ? velocity + cross(turn, x.xyz - substep * v.xyz - centre) : vec3(0.0);
    velocity_out[index] = vec4(v.xyz + change, v.w);
    position_out[index] = vec4(changed_position(index, x.xyz, substep * change), x.w);
}
