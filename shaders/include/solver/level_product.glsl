// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The matrix of a coarse level times a vector, for a block: value in, product out.

#include "block_edges.glsl"
#include "solver/block_of_invocation.glsl"
#include "solver/edge_tensors.glsl"

#define REACH 1
#define TILE (BLOCK + 2 * REACH)

vec3 value[TILE][TILE];
vec3 product[TILE][TILE];

ivec2 first_of_block() { return BLOCK * block_of_invocation(level_shape[level].y); }

bool in_level(ivec2 first) { return inside(level, first.y, first.x); }

int tile_index(ivec2 first, int row, int col) {
    return level_index(level, first.y + row - REACH, first.x + col - REACH);
}

bool tile_inside(ivec2 first, int row, int col) {
    return inside(level, first.y + row - REACH, first.x + col - REACH);
}

void add_to_product(ivec2 first, int row, int col, int drow, int dcol, int direction) {
    Symmetric edge = load_edge(level, tile_index(first, row, col), direction);
    vec3 part = times(edge, value[row][col] - value[row + drow][col + dcol]);
    product[row][col] += part;
    product[row + drow][col + dcol] -= part;
}

void load_values(ivec2 first, int field) {
    FOR_TILE {
        value[row][col] = load_vector(vector_entry(level, field, tile_index(first, row, col)));
    }
}

#define ADD_PRODUCTS(FIRST, EDGE, DROW, DCOL, FAMILY, REST) \
    FOR_BLOCK_EDGES(DROW, DCOL, add_to_product(FIRST, row, col, DROW, DCOL, EDGE))

void make_product(ivec2 first) {
    FOR_TILE {
        product[row][col] = vec3(0.0);
    }
    FOR_BLOCK {
        product[row][col] = times(
            load_symmetric(level, GROUND, tile_index(first, row, col)), value[row][col]);
    }
    EACH_SHORT_EDGE(ADD_PRODUCTS, first)
}
