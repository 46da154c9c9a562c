// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Give the impulses that rounds over the lattice have found to all nodes at listed edges.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "limit_lists.glsl"
#include "limit_impulses.glsl"

uniform float substep;  // [s]

#include "limit_give.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = LIMIT_FIGURES) writeonly buffer Figures { vec2 block_figures[]; };

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    ivec2 first = block * BLOCK;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    // How many edges have an impulse, and the energy that is given over the mass of a node
    // [m2/s2].
    vec2 given = vec2(0.0);
    for (int row = 0; row < BLOCK; ++row) {
        for (int col = 0; col < BLOCK; ++col) {
            int index = node_index(first.y + row, first.x + col);
            // As in solver/contact.comp, software would run the body of a branch for every node.
            for (uint asks = listed_at(index) > 0.0 ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
                given += give(index);
            }
        }
    }
    block_figures[block.y * BLOCKS_ACROSS + block.x] = given;
}
