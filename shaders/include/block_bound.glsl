// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Which blocks of nodes may come to a collider in an explicit substep, by what bounds their places
// and speeds.

#include "collider_bounds.glsl"
#include "near_blocks.glsl"

// More than the rounding of a radius.
#define WIDER 1.00001

// A box around the nodes of the block, and the square of their largest speed.
struct Bound {
    vec3 least;
    vec3 most;
    float fastest;
};

void add_place(inout Bound bound, vec4 x) {
    bool is_node = x.w > 0.0;
    bound.least = min(bound.least, is_node ? x.xyz : bound.least);
    bound.most = max(bound.most, is_node ? x.xyz : bound.most);
}

void add_speed(inout Bound bound, vec3 v) {
    float square = dot(v, v);
    // NaN counts as fast, so that the block is listed.
    bound.fastest = square <= bound.fastest ? bound.fastest : square < 1e30 ? square : 1e30;
}

// List the block if any of its nodes may reach a collider in the substep.
void list_if_near(Bound bound, ivec2 first) {
#if OWN_BODIES
    take_places(first.y);
#endif
    uint bodies = near_bodies(
        0.5 * (bound.least + bound.most), 0.5 * WIDER * length(bound.most - bound.least),
        substep * sqrt(bound.fastest));
    // A loop that ends at once costs software less than a branch, whose body it runs.
    for (uint asks = bodies != 0u ? 1u : 0u; asks != 0u; asks &= asks - 1u) {
        uint place = atomicAdd(near_block_count, 1u);
        near[place] = Near(uint(node_index(first.y, first.x)), bodies);
        atomicAdd(block_groups_x, place % BLOCKS_AT_ONCE == 0u ? 1u : 0u);
    }
}
