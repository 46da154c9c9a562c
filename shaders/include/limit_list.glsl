// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// List the edges of a block that come near a limit in an explicit substep that has been made,
// judged with the impulses of the previous substep. load_next_position and load_change have to be
// there.

#include "cells.glsl"

uniform float near;  // strain over the limit from which on an edge is listed
uniform bool adds;   // to those listed in this substep, not to those with an impulse before

#define TILE_COLS (BLOCK + 2)
#define TILE_ROWS (BLOCK + 1)

// Expected place [m], and in w 0 for a ghost.
vec4 expected[TILE_ROWS][TILE_COLS];
uint engaged[TILE_ROWS][TILE_COLS];

uint listed(int row, int col, int drow, int dcol, int edge, int rest) {
    vec4 from = expected[row][col];
    vec4 to = expected[row + drow][col + dcol];
    vec3 d = to.xyz - from.xyz;
    float square = dot(d, d);
    bool is_edge = edge_share(from, to, edge) > 0.0;
    uint was = engaged[row][col] >> edge;
    // NaN is not listed; the check of the state finds it.
    bool is_long = is_edge && (
        square > square_at(rest, near * limit) || (was & 1u) != 0u);
    bool is_short = is_edge && (
        square < square_at(rest, -near * limit) || (was & 1u << SHORTEST) != 0u);
    // What has crossed from one limit to the other is at that.
    is_long = is_long && !(is_short && square < square_at(rest, 0.0));
    is_short = is_short && !is_long;
    return (is_long ? 1u : 0u) << edge | (is_short ? 1u : 0u) << (edge + SHORTEST);
}

#define LIST(MASKED, EDGE, DROW, DCOL, FAMILY, REST) \
    if ((FAMILY == SHEAR ? HAS_SHEAR : HAS_STRUCTURAL) == 1) { \
        MASKED |= listed(row, col, DROW, DCOL, EDGE, REST); \
    }

void list_block(int block) {
    ivec2 first = ivec2(block % BLOCKS_ACROSS, block / BLOCKS_ACROSS) * BLOCK;
    for (int row = 0; row < TILE_ROWS; ++row) {
        for (int col = 0; col < TILE_COLS; ++col) {
            int index = node_index(first.y + row, first.x + col - 1);
            vec4 x = load_next_position(index);
            vec4 change = load_change(index);
            expected[row][col] = vec4(x.xyz + substep * change.xyz, x.w);
            engaged[row][col] = adds ? MASK(index) : uint(change.w);
        }
    }
    uint count = 0u;
    uint added = 0u;
    for (int row = 0; row < BLOCK; ++row) {
        for (int col = 1; col <= BLOCK; ++col) {
            uint mask = 0u;
            EACH_SHORT_EDGE(LIST, mask)
            MASK(node_index(first.y + row, first.x + col - 1)) = mask;
            count += uint(bitCount(mask));
            added += uint(bitCount(mask & ~engaged[row][col]));
        }
    }
    lists[COUNTS_AT + block] = count;
    if (adds && added > 0u) {
        atomicAdd(newly_listed, added);
    }
}
