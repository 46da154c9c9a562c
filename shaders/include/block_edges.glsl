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

#define FOR_BLOCK \
    for (int row = REACH; row < REACH + BLOCK; ++row) \
        for (int col = REACH; col < REACH + BLOCK; ++col)
