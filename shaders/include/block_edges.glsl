// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Every edge of one direction with an end in the block: EDGE is evaluated with row and col of its
// first end in the tile. TILE is the block with REACH nodes on each side.

#define FOR_BLOCK_EDGES(DROW, DCOL, EDGE) \
    for (int row = 0; row < TILE; ++row) { \
        for (int col = 0; col < TILE; ++col) { \
            bool starts = row >= REACH && row < REACH + BLOCK \
                && col >= REACH && col < REACH + BLOCK; \
            bool ends = row + DROW >= REACH && row + DROW < REACH + BLOCK \
                && col + DCOL >= REACH && col + DCOL < REACH + BLOCK; \
            if (starts || ends) { \
                EDGE; \
            } \
        } \
    }

#define FOR_TILE \
    for (int row = 0; row < TILE; ++row) \
        for (int col = 0; col < TILE; ++col)

// Mesa unrolls a loop of any length if it runs over all of an array, and else up to a limit. Where
// one is left, llvmpipe keeps the tiles in memory and compiles a shader for minutes.
#define FOR_BLOCK \
    FOR_TILE \
        if (row >= REACH && row < REACH + BLOCK && col >= REACH && col < REACH + BLOCK)
