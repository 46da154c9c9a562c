// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The inverse of the diagonal block of a node of a coarse level.

#include "solver/edge_tensors.glsl"

void invert_node(int row, int col) {
    int index = level_index(level, row, col);
    Symmetric diagonal = load_symmetric(level, GROUND, index);
    for (int i = 0; i < DIRECTIONS; ++i) {
        int behind = level_index(level, row - TOWARDS[i].x, col - TOWARDS[i].y);
        diagonal += load_edge(level, index, i) + load_edge(level, behind, i);
    }
    // No coarse node with a node of the cloth holds less than a quarter of a cell's mass.
#if HAS_CELLS
    store_symmetric(level, INVERSE, index, inverse_above(diagonal, 0.25));
#else
    store_symmetric(level, INVERSE, index, inverse_above(diagonal, 1.0));
#endif
}
