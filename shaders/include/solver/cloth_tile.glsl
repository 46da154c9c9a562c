// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The tile of cloth nodes that a block needs, and a walk over all its edges.

#include "block_edges.glsl"
#include "cells.glsl"
#include "solver/block_of_invocation.glsl"

#if HAS_BEND || HAS_RIGIDITY
#define REACH 2
#else
#define REACH 1
#endif
#define TILE (BLOCK + 2 * REACH)

vec4 node[TILE][TILE];
vec4 along[TILE][TILE];   // of the edges that begin at a node, as in solver/levels.glsl
vec4 across[TILE][TILE];

// What a node is stands in w: that of cells.glsl, or less that for a pinned one.
bool is_free(vec4 node) { return node.w > 0.0; }

// Share of an edge with an end that can move, 0 elsewhere.
float moving_share(vec4 from, vec4 to, int edge) {
#if HAS_CELLS
    return max(from.w, to.w) > 0.0 ? edge_share(from, to, edge) : 0.0;
#else
    return from.w * to.w != 0.0 && max(from.w, to.w) > 0.0 ? 1.0 : 0.0;
#endif
}

ivec2 first_of_block() { return BLOCK * block_of_invocation(COLS); }

bool in_cloth(ivec2 first) { return first.x < COLS && first.y < ROWS; }

int tile_index(ivec2 first, int row, int col) {
    return node_index(first.y + row - REACH, first.x + col - REACH);
}

bool is_in_block(int row, int col) {
    return row >= REACH && row < REACH + BLOCK && col >= REACH && col < REACH + BLOCK;
}

// DO(row, col, drow, dcol, edge, family, rest) for every edge with an end in the block.
#define FOR_CLOTH_EDGES(DO) EACH_EDGE(FOR_EDGES_OF_KIND, DO)
#define FOR_EDGES_OF_KIND(DO, EDGE, DROW, DCOL, FAMILY, REST) \
    FOR_BLOCK_EDGES(DROW, DCOL, DO(row, col, DROW, DCOL, EDGE, FAMILY, REST))
