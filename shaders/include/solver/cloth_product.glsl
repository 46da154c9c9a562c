// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// The matrix times a vector on the cloth, for a block: value in, product out. The mass, and what
// edges resist along and across their directions, over the node mass; the rows of pinned nodes,
// and of nodes that touch a collider what is not along it, are zero.

#include "solver/cloth_tile.glsl"
#include "solver/cloth_edges.glsl"
#include "solver/free_directions.glsl"
#if HAS_RIGIDITY
#include "block_bending.glsl"

// beta h^2 c along a row and along a column, over the node mass.
uniform float bending_weight[2];
#endif
#if HAS_BENDING_DAMPING
#include "solver/bent_lines.glsl"
#endif

vec3 value[TILE][TILE];
vec3 product[TILE][TILE];

void add_to_product(int row, int col, int drow, int dcol, int edge, int family, int rest) {
    vec3 d = node[row][col].xyz - node[row + drow][col + dcol].xyz;
    vec3 u = value[row][col] - value[row + drow][col + dcol];
    vec3 part = (weight_along(row, col, edge) * dot(d, u)) * d
        + weight_across(row, col, edge) * u;
    product[row][col] += part;
    product[row + drow][col + dcol] -= part;
}

void load_values(ivec2 first, int field) {
    FOR_TILE {
        value[row][col] = load_vector(cloth_entry(field, tile_index(first, row, col)));
    }
}

void add_edges_to_product(ivec2 first) {
    FOR_CLOTH_EDGES(add_to_product)
#if HAS_RIGIDITY
    vec3 resisted[TILE][TILE];
    FIND_BENDING(resisted, value, node, bending_weight)
    FOR_BLOCK {
        product[row][col] += resisted[row][col];
    }
#endif
#if HAS_BENDING_DAMPING
    ADD_BENT_LINES(product, value, first)
#endif
}

// In all directions, also those in which a node can't follow, and without friction.
void make_whole_product(ivec2 first) {
    FOR_TILE {
        product[row][col] = mass_share(node[row][col]) * value[row][col];
    }
    add_edges_to_product(first);
}

void make_product(ivec2 first) {
    FOR_TILE {
        product[row][col] = mass_share(node[row][col]) * value[row][col];
    }
#if HAS_CONTACT
    FOR_BLOCK {
        product[row][col] += mass_share(node[row][col])
            * gripped(tile_index(first, row, col), value[row][col]);
    }
#endif
    add_edges_to_product(first);
    FOR_BLOCK {
        product[row][col] = is_free(node[row][col])
            ? in_free_directions(tile_index(first, row, col), product[row][col]) : vec3(0.0);
    }
}
