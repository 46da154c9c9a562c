// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Mark the blocks with edges that may come near a limit in an explicit substep that has been made,
// or in some that follow: STRIP nodes of a column an invocation.

#include "lattice.glsl"
#include "cells.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "limit_lists.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#include "next_state.glsl"

#if LOADS_TEXTURE
layout(binding = LIMIT_CHANGES) uniform samplerBuffer changes;
vec3 load_change(int index) { return texelFetch(changes, index).xyz; }
#else
layout(std430, binding = LIMIT_CHANGES) readonly buffer Changes { vec4 changes[]; };
vec3 load_change(int index) { return changes[index].xyz; }
#endif

uniform float substep;  // [s]
uniform float ahead;  // [s] that the look reaches beyond the substep
uniform float wide;   // strain over the limit from which on a block is marked
float h = READ_FIRST(substep);
float way_ahead = READ_FIRST(ahead);
float wide_strain = READ_FIRST(wide) * strain_limit;

struct Node {
    vec4 now;   // [m], and in w 0 for a ghost
    vec3 then;  // [m]
};

Node load_node(int row, int col) {
    int index = node_index(row, col);
    vec4 x = load_next_position(index);
    vec3 v = load_next_velocity(index).xyz;
#if HAS_CONTACT
    // What colliders stopped in the previous substep, they stop in this one.
    vec3 change = load_change(index);
    x.xyz += h * change;
    v += change;
#endif
    return Node(x, x.xyz + way_ahead * v);
}

bool is_wide(Node from, Node to, int edge, int rest) {
    vec3 now = to.now.xyz - from.now.xyz;
    vec3 then = to.then - from.then;
    vec2 squares = vec2(dot(now, now), dot(then, then));
    bool is_off = max(squares.x, squares.y) > square_at(rest, wide_strain)
        || min(squares.x, squares.y) < square_at(rest, -wide_strain);
    return is_off && edge_share(from.now, to.now, edge) > 0.0;
}

// Mark the block of a node, and those around it: impulses reach one edge further in each substep.
void mark(int row, int col) {
    ivec2 middle = ivec2(col, row) / BLOCK;
    ivec2 first = max(middle - 1, ivec2(0));
    ivec2 last = min(middle + 1, ivec2(COLS - 1, ROWS - 1) / BLOCK);
    for (int y = first.y; y <= last.y; ++y) {
        for (int x = first.x; x <= last.x; ++x) {
            int block = y * BLOCKS_ACROSS + x;
            if (lists[block] == 0u && atomicExchange(lists[block], 1u) == 0u) {
                uint place = atomicAdd(marked_count, 1u);
                lists[MARKED_AT + int(place)] = uint(block);
                atomicAdd(list_groups_x, place % LIST_LOCAL == 0u ? 1u : 0u);
            }
        }
    }
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int first = int(gl_GlobalInvocationID.y) * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    Node here = load_node(first, col);
    Node right = load_node(first, col + 1);
    uint rows = 0u;       // that have a wide edge which starts in this column, a bit each
    uint crossings = 0u;  // or in the next one
    for (int row = 0; row < STRIP; ++row) {
        Node below = load_node(first + row + 1, col);
        Node below_right = load_node(first + row + 1, col + 1);
        bool is_any = false;
#if HAS_STRUCTURAL
        is_any = is_wide(here, right, EDGE_ROW, REST_ROW) || is_wide(here, below, EDGE_COLUMN, REST_COLUMN);
#endif
#if HAS_SHEAR
        is_any = is_any || is_wide(here, below_right, EDGE_DIAGONAL, REST_DIAGONAL);
        crossings |= is_wide(right, below, EDGE_CROSSING, REST_DIAGONAL) ? 1u << row : 0u;
#endif
        rows |= is_any ? 1u << row : 0u;
        here = below;
        right = below_right;
    }
    for (; rows != 0u; rows &= rows - 1u) {
        mark(first + findLSB(rows), col);
    }
    for (; crossings != 0u; crossings &= crossings - 1u) {
        mark(first + findLSB(crossings), col + 1);
    }
}
