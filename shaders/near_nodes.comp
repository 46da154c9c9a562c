// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// List the nodes that may reach a collider in an explicit substep, from the blocks listed by
// mass_spring_step.comp: contact.comp is expensive for each node.

#include "lattice.glsl"
#include "state_in.glsl"
#include "collider_bounds.glsl"
#if HAS_SURFACE
#include "contact.glsl"
#include "near_surface.glsl"
#endif
#include "near_blocks.glsl"

layout(local_size_x = NEAR_LOCAL) in;

#include "next_state.glsl"

uniform float substep;    // [s]
uniform int block_count;  // in all

void main() {
    float h = READ_FIRST(substep);
    uint nodes_at = uint(READ_FIRST(block_count));
    uint place = gl_GlobalInvocationID.x / uint(BLOCK * BLOCK);
    if (place >= listed_blocks()) {
        return;
    }
    Near block = listed_at_place(place);
    int inside = int(gl_GlobalInvocationID.x % uint(BLOCK * BLOCK));
    int index = int(block.index) + inside / BLOCK * PITCH + inside % BLOCK;
#if OWN_BODIES
    take_places(index / PITCH - HALO);
#endif
    vec4 v = load_next_velocity(index);
    // NaN fails the comparison and counts as fast, so that the node is listed.
    float square = dot(v.xyz, v.xyz);
    float way = h * sqrt(square < 1e30 ? square : 1e30);
    vec4 x = load_position(index);
#if HAS_SURFACE
    // Pinned nodes are listed too: an edge to a free node may touch.
    bool counts = x.w != 0.0;
#else
    bool counts = v.w > 0.0;
#endif
    uint bodies = counts ? near_among(block.bodies, x.xyz, way) : 0u;
#if HAS_SURFACE
    bodies = near_surface(bodies, x.xyz, v.xyz, h);
#endif
    if (bodies != 0u) {
        uint entry = atomicAdd(near_node_count, 1u);
        near[nodes_at + entry] = Near(uint(index), bodies);
        atomicAdd(node_groups_x, entry % NEAR_LOCAL == 0u ? 1u : 0u);
    }
}
