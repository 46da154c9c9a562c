// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// List the edges of a block that come near a limit in an explicit substep that has been made,
// judged with the impulses of the previous substep. load_next_position and load_change have to be
// there.

#include "cells.glsl"

uniform float near;  // strain over the limit from which on an edge is listed
uniform bool adds;   // to those listed in this substep, not to those with an impulse before
float listed_strain = READ_FIRST(near) * strain_limit;

// Expected place [m] of a node, and in w 0 for a ghost; change: of its velocity [m/s].
vec4 expected_place(int index, vec3 change) {
    vec4 x = load_next_position(index);
    return vec4(x.xyz + h * change, x.w);
}

uint listed(vec4 from, uint was, int index, int edge, int rest) {
    int end = index + end_offset(edge);
    vec4 to = expected_place(end, load_change(end).xyz);
    vec3 d = to.xyz - from.xyz;
    float square = dot(d, d);
    bool is_edge = edge_share(from, to, edge) > 0.0;
    was >>= edge;
    // NaN is not listed; the check of the state finds it.
    bool is_long = is_edge && (
        square > square_at(rest, listed_strain) || (was & 1u) != 0u);
    bool is_short = is_edge && (
        square < square_at(rest, -listed_strain) || (was & 1u << SHORTEST) != 0u);
    // What has crossed from one limit to the other is at that.
    is_long = is_long && !(is_short && square < square_at(rest, 0.0));
    is_short = is_short && !is_long;
    return (is_long ? 1u : 0u) << edge | (is_short ? 1u : 0u) << (edge + SHORTEST);
}

#define LIST(MASKED, EDGE, DROW, DCOL, FAMILY, REST) \
    if ((FAMILY == SHEAR ? HAS_SHEAR : HAS_STRUCTURAL) == 1) { \
        MASKED |= listed(from, was, index, EDGE, REST); \
    }

// One node after another: unrolled, a block takes llvmpipe seconds to compile.
void list_block(int block) {
    ivec2 first = ivec2(block % BLOCKS_ACROSS, block / BLOCKS_ACROSS) * BLOCK;
    uint count = 0u;
    uint added = 0u;
    for (int inside = 0; inside < BLOCK * BLOCK; ++inside) {
        int index = node_index(first.y + inside / BLOCK, first.x + inside % BLOCK);
        vec4 change = load_change(index);
        vec4 from = expected_place(index, change.xyz);
        uint was = adds ? MASK(index) : uint(change.w);
        uint mask = 0u;
        EACH_SHORT_EDGE(LIST, mask)
        MASK(index) = mask;
        count += uint(bitCount(mask));
        added += uint(bitCount(mask & ~was));
    }
    lists[COUNTS_AT + block] = count;
    if (adds && added > 0u) {
        atomicAdd(newly_listed, added);
    }
}
