// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Bending by the linear law of docs/explanation/numerics.md: three nodes in a line, along a row or
// a column, store c / 2 D^2 with their second difference D, and a node at place i of its line
// feels -c (D[i-1] - 2 D[i] + D[i+1]). A line that leaves the cloth stores nothing.

// Of a quantity at three nodes in a line; present is 0 where one of them is a ghost.
vec3 second_difference(float present, vec3 behind, vec3 here, vec3 ahead) {
    return abs(present) * ((behind - here) + (ahead - here));
}

// Both neighbours first: a mirrored cloth rounds alike.
vec3 unbent(vec3 behind, vec3 here, vec3 ahead) { return (behind + ahead) - 2.0 * here; }

// Of a tile OF with two nodes on each side of the block, and nodes in the tile NODE whose w is 0
// for a ghost.
#define BENT(OF, NODE, ROW, COL, DROW, DCOL) second_difference( \
    NODE[ROW - DROW][COL - DCOL].w * NODE[ROW][COL].w * NODE[ROW + DROW][COL + DCOL].w, \
    OF[ROW - DROW][COL - DCOL].xyz, OF[ROW][COL].xyz, OF[ROW + DROW][COL + DCOL].xyz)

#define FOR_BENT(DROW, DCOL) \
    for (int row = 2 - DROW; row < BLOCK + 2 + DROW; ++row) \
        for (int col = 2 - DCOL; col < BLOCK + 2 + DCOL; ++col)

// What bending resists at the nodes of the block, into RESISTED; C is c along a row and along a
// column. Both second differences are kept: they are found once for three nodes.
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
