// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The tension of each edge, over the node mass: that of the right side plus the part of the
// solution.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_tile.glsl"
#include "solver/cloth_edges.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;  // [s]

vec3 solution[TILE][TILE];
vec4 tension[TILE][TILE];
#if HAS_BEND
vec4 bend_tension[TILE][TILE];
#endif

void find(int row, int col, int drow, int dcol, int edge, int family, int rest) {
    if (!is_in_block(row, col)) {
        return;
    }
    vec3 d = node[row][col].xyz - node[row + drow][col + dcol].xyz;
    float square = max(dot(d, d), 1e-20);
    float weight = weight_along(row, col, edge) * square + weight_across(row, col, edge);
    float added = weight * dot(d, solution[row][col] - solution[row + drow][col + dcol])
        * inversesqrt(square) / substep;
#if HAS_BEND
    if (edge >= EDGE_TWO_ROW) {
        int slot = LONG_SLOT(edge);
        bend_tension[row][col][slot] = bend_tension[row][col][slot + 2] + added;
        return;
    }
#endif
    tension[row][col][SHORT_SLOT(edge)] += added;
}

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    load_edges(first);
    FOR_TILE {
        int entry = tile_index(first, row, col);
        solution[row][col] = load_vector(cloth_entry(SOLUTION, entry));
        tension[row][col] = load_system(cloth_entry(BEGUN, entry));
#if HAS_BEND
        bend_tension[row][col] = load_system(cloth_entry(BEND_TENSION, entry));
#endif
    }
    FOR_CLOTH_EDGES(find)
    FOR_BLOCK {
        int entry = tile_index(first, row, col);
        system_data[cloth_entry(TENSION, entry)] = tension[row][col];
#if HAS_BEND
        system_data[cloth_entry(BEND_TENSION, entry)] = bend_tension[row][col];
#endif
    }
}
