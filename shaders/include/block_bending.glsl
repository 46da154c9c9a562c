// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Bending for all nodes of a block.

#include "bending.glsl"
#include "cells.glsl"

// Second difference in a tile OF with two nodes on each side of the block; NODE is the tile of the
// nodes, whose w is as in cells.glsl.
#define BENT_SHARE(NODE, ROW, COL, DROW, DCOL) line_share( \
    NODE[ROW - DROW][COL - DCOL], NODE[ROW][COL], NODE[ROW + DROW][COL + DCOL], DROW)
#define BENT(OF, NODE, ROW, COL, DROW, DCOL) second_difference( \
    BENT_SHARE(NODE, ROW, COL, DROW, DCOL), \
    OF[ROW - DROW][COL - DCOL].xyz, OF[ROW][COL].xyz, OF[ROW + DROW][COL + DCOL].xyz)

// Over all of a tile, for the reason at FOR_BLOCK in block_edges.glsl.
#define FOR_BENT(DROW, DCOL) \
    for (int row = 0; row < BLOCK + 4; ++row) \
        for (int col = 0; col < BLOCK + 4; ++col) \
            if (row >= 2 - DROW && row < BLOCK + 2 + DROW \
                    && col >= 2 - DCOL && col < BLOCK + 2 + DCOL)

// Bending forces on the nodes of the block, into RESISTED; C: c along a row and along a column.
// Second differences are stored, as each is used by three nodes.
#define FIND_BENDING(RESISTED, OF, NODE, C) { \
    vec3 bent[BLOCK + 4][BLOCK + 4]; \
    FOR_BENT(0, 1) { bent[row][col] = BENT(OF, NODE, row, col, 0, 1); } \
    FOR_BENT(0, 0) { \
        RESISTED[row][col] = \
            C[0] * unbent(bent[row][col - 1], bent[row][col], bent[row][col + 1]); \
    } \
    FOR_BENT(1, 0) { bent[row][col] = BENT(OF, NODE, row, col, 1, 0); } \
    FOR_BENT(0, 0) { \
        RESISTED[row][col] += \
            C[1] * unbent(bent[row - 1][col], bent[row][col], bent[row + 1][col]); \
    } \
}
