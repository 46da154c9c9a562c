// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The edges of a coarse node as averages of the finer ones along them, which keeps the coarse
// system one of edges. Includer: Symmetric finer_edge(row, col, direction), where (0, 0) is the
// upper left of the four finer nodes that are one here.

#define EDGE(ROW, COL) finer_edge(first + ivec2(ROW, COL), direction)

Symmetric average_edge(ivec2 first, int direction) {
    switch (direction) {
    case 0:
        return 0.125 * (EDGE(0, 0) + EDGE(1, 0) + EDGE(0, 2) + EDGE(1, 2))
            + 0.25 * (EDGE(0, 1) + EDGE(1, 1));
    case 1:
        return 0.125 * (EDGE(0, 0) + EDGE(0, 1) + EDGE(2, 0) + EDGE(2, 1))
            + 0.25 * (EDGE(1, 0) + EDGE(1, 1));
    case 2:
        return 0.125 * (EDGE(0, 0) + EDGE(2, 2))
            + 0.25 * (EDGE(1, 1) + EDGE(0, 1) + EDGE(1, 0));
    default:
        return 0.125 * (EDGE(0, 1) + EDGE(2, -1))
            + 0.25 * (EDGE(1, 0) + EDGE(0, 0) + EDGE(1, 1));
    }
}

// Without those that would leave the level.
bool stays_inside(int row, int col, int direction) {
    ivec2 end = ivec2(row, col) + TOWARDS[direction];
    return end.y >= 0 && inside(level, end.x, end.y);
}
