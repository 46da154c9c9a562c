// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Velocities of the nodes at listed edges by their impulses: BLOCK x BLOCK nodes an invocation,
// all over the lattice.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "limit_lists.glsl"
#include "limit_lattice.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

// Velocity of each node [m/s], and in w its listed edges over its mass.
layout(std430, binding = LIMIT_CHANGES) buffer Changes { vec4 changes[]; };

uniform float substep;  // [s]
uniform bool counts_edges;

#include "limit_contact.glsl"

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    ivec2 first = block * BLOCK;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    // As in solver/contact.comp, software would run the body of a branch for every block.
    for (uint asks = has_listed_nodes(block) ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        for (int row = 0; row < BLOCK; ++row) {
            for (int col = 0; col < BLOCK; ++col) {
                int index = node_index(first.y + row, first.x + col);
                vec4 v = load_next_velocity(index);
                changes[WORK_AT + index].xyz = after_contact(
                    index, v.xyz + v.w * load_impulse_on(index), v.w > 0.0);
                if (counts_edges) {
                    changes[WORK_AT + index].w = v.w * listed_at(index);
                }
            }
        }
    }
}
