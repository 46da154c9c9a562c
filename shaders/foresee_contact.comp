// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Predicted mean velocity of each node over the time ahead, with applied forces and contact. A node
// that a collider stops falls behind its neighbours, which the edges alone do not predict.

#include "lattice.glsl"
#include "state_in.glsl"
#include "applied_acceleration.glsl"
#include "contact.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = VELOCITY_OUT) buffer VelocityOut { vec4 velocity_out[]; };

uniform float substep;  // [s] the time ahead

void main() {
    float h = READ_FIRST(substep);
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 v = load_velocity(index);
    vec3 x = load_position(index).xyz;
    vec3 without = v.xyz + (v.w > 0.0 ? h * applied_acceleration(index) : vec3(0.0));
    v.xyz = without;
    // llvmpipe runs the body of a branch for all nodes, but skips a loop without rounds
    // (solver/contact.comp).
    bool is_near = v.w > 0.0 && near_bodies(x, 0.0, h * length(without)) != 0u;
    for (uint asks = is_near ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        v.xyz = contact_at(x, without, without, h).velocity;
    }
    velocity_out[index] = v;
}
