// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Stiffness of the edges of a tile, from the entries that right_side.comp has stored.

#include "solver/edge_slots.glsl"

#if HAS_BEND
vec4 bend_weight[TILE][TILE];
#endif

void load_edges(ivec2 first) {
    FOR_TILE {
        int entry = tile_index(first, row, col);
        node[row][col] = load_system(cloth_entry(NODE, entry));
        along[row][col] = load_system(cloth_entry(ALONG, entry));
        across[row][col] = load_system(cloth_entry(ACROSS, entry));
#if HAS_BEND
        bend_weight[row][col] = load_system(cloth_entry(BEND_WEIGHT, entry));
#endif
    }
}

float weight_along(int row, int col, int edge) {
#if HAS_BEND
    if (edge >= EDGE_TWO_ROW) {
        return bend_weight[row][col][LONG_SLOT(edge)];
    }
#endif
    return along[row][col][SHORT_SLOT(edge)];
}

float weight_across(int row, int col, int edge) {
#if HAS_BEND
    if (edge >= EDGE_TWO_ROW) {
        return bend_weight[row][col][LONG_SLOT(edge) + 2];
    }
#endif
    return across[row][col][SHORT_SLOT(edge)];
}
