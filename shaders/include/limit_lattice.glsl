// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// What the passes over the lattice read in a round: velocities that the springs have written, and
// impulses as in limit_impulses.glsl, three texels a node.

#include "next_state.glsl"

#if LOADS_TEXTURE
layout(binding = LIMIT_IMPULSES) uniform samplerBuffer impulse_texels;
layout(binding = LIMIT_PREVIOUS) uniform samplerBuffer previous_texels;
vec4 load_impulses(int texel) { return texelFetch(impulse_texels, texel); }
vec4 load_previous(int texel) { return texelFetch(previous_texels, texel); }
#else
layout(std430, binding = LIMIT_IMPULSES) readonly buffer Impulses { vec4 impulse_texels[]; };
layout(std430, binding = LIMIT_PREVIOUS) readonly buffer Previous { vec4 previous_texels[]; };
vec4 load_impulses(int texel) { return impulse_texels[texel]; }
vec4 load_previous(int texel) { return previous_texels[texel]; }
#endif

// Fractions of the impulses after the last round and before it whose sum the next one starts from.
uniform vec2 parts;
vec2 taken = READ_FIRST(parts);

vec4 load_start(int texel) {
    return taken.x * load_impulses(texel) + taken.y * load_previous(texel);
}

// Impulses of the four edges that start at a node [m/s].
struct Impulses4 {
    vec4 first;
    vec4 second;
    vec4 third;
};

vec3 of_edge(Impulses4 all, int edge) {
    return edge == EDGE_ROW ? all.first.xyz
        : edge == EDGE_COLUMN ? vec3(all.first.w, all.second.xy)
        : edge == EDGE_DIAGONAL ? vec3(all.second.zw, all.third.x) : all.third.yzw;
}

Impulses4 set_edge(Impulses4 all, int edge, vec3 value) {
    all.first = edge == EDGE_ROW ? vec4(value, all.first.w)
        : edge == EDGE_COLUMN ? vec4(all.first.xyz, value.x) : all.first;
    all.second = edge == EDGE_COLUMN ? vec4(value.yz, all.second.zw)
        : edge == EDGE_DIAGONAL ? vec4(all.second.xy, value.xy) : all.second;
    all.third = edge == EDGE_DIAGONAL ? vec4(value.z, all.third.yzw)
        : edge == EDGE_CROSSING ? vec4(all.third.x, value) : all.third;
    return all;
}

// Sum of those on a node.
vec3 load_impulse_on(int index) {
    Impulses4 own = Impulses4(
        load_start(3 * index), load_start(3 * index + 1), load_start(3 * index + 2));
    int column = 3 * START(index, EDGE_COLUMN);
    int diagonal = 3 * START(index, EDGE_DIAGONAL);
    Impulses4 others = Impulses4(
        load_start(column), load_start(column + 1), vec4(0.0));
    Impulses4 more = Impulses4(
        vec4(0.0), load_start(diagonal + 1), load_start(diagonal + 2));
    return of_edge(own, EDGE_ROW) - load_start(3 * START(index, EDGE_ROW)).xyz
        + of_edge(own, EDGE_COLUMN) - of_edge(others, EDGE_COLUMN)
        + of_edge(own, EDGE_DIAGONAL) - of_edge(more, EDGE_DIAGONAL)
        + of_edge(own, EDGE_CROSSING) - load_start(3 * START(index, EDGE_CROSSING) + 2).yzw;
}

// Whether a listed edge starts in the block; whether one starts or ends there.
bool has_listed_edges(ivec2 block) {
    return lists[COUNTS_AT + block.y * BLOCKS_ACROSS + block.x] != 0u;
}

bool has_listed_nodes(ivec2 block) {
    bool has = false;
    for (int row = max(block.y - 1, 0); row <= block.y; ++row) {
        for (int col = max(block.x - 1, 0); col <= min(block.x + 1, BLOCKS_ACROSS - 1); ++col) {
            has = has || has_listed_edges(ivec2(col, row));
        }
    }
    return has;
}
