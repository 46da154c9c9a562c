// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The system of a coarse level from that of the level above.

#include "solver/edge_tensors.glsl"
#if HAS_RIGIDITY
#include "solver/coarse_bending.glsl"
#endif

Symmetric finer_edge(ivec2 at, int direction) {
    Symmetric edge = load_edge(level - 1, level_index(level - 1, at.x, at.y), direction);
#if HAS_RIGIDITY
    ivec2 end = at + TOWARDS[direction];
    if (end.y >= 0 && inside(level - 1, at.x, at.y) && inside(level - 1, end.x, end.y)) {
        edge -= bending_edge(level - 1, direction);
    }
#endif
    return edge;
}

#include "solver/average_edges.glsl"

Symmetric finer_ground(int row, int col) {
    return load_symmetric(level - 1, GROUND, level_index(level - 1, row, col));
}

void coarsen_node(int row, int col) {
    int index = level_index(level, row, col);
    Symmetric edges[DIRECTIONS];
    for (int i = 0; i < DIRECTIONS; ++i) {
        edges[i] = stays_inside(row, col, i)
            ? average_edge(2 * ivec2(row, col), i) : Symmetric(0.0);
#if HAS_RIGIDITY
        if (stays_inside(row, col, i)) {
            edges[i] += bending_edge(level, i);
        }
#endif
    }
    store_edges(level, index, edges);
    store_symmetric(
        level, GROUND, index,
        finer_ground(2 * row, 2 * col) + finer_ground(2 * row, 2 * col + 1)
            + finer_ground(2 * row + 1, 2 * col) + finer_ground(2 * row + 1, 2 * col + 1));
}
