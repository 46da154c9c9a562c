// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the blocks that may reach a collider in an explicit substep, by its velocities after strain
// limits: BLOCK x BLOCK nodes per invocation.

#include "lattice.glsl"
#include "state_in.glsl"

uniform float substep;  // [s]

#include "block_bound.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#include "next_state.glsl"

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * BLOCK;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    Bound bound = Bound(vec3(1e30), vec3(-1e30), 0.0);
    for (int row = 0; row < BLOCK; ++row) {
        for (int col = 0; col < BLOCK; ++col) {
            int index = node_index(first.y + row, first.x + col);
            add_place(bound, load_position(index));
            add_speed(bound, load_next_velocity(index).xyz);
        }
    }
    list_if_near(bound, first);
}
