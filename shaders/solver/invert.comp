// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Invert the diagonal blocks of a coarse level.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/edge_tensors.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (!inside(level, row, col)) {
        return;
    }
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
