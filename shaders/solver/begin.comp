// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Before the first iteration: where the solution starts, what that leaves of the right side and of what
// the pass before has left, and its first smoothing.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform int start_field;  // where the solution starts, of which
uniform float guess;      // this share
uniform float left_share; // of what the pass before has left: 1, or 0 where there was none

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    load_edges(first);
    load_values(first, start_field);
    FOR_TILE {
        value[row][col] *= is_free(node[row][col]) ? guess : 0.0;
    }
    make_product(first);
    // A loop of its own: in the one below it takes llvmpipe five times as long.
    FOR_BLOCK {
        int index = tile_index(first, row, col);
        vec3 left = is_free(node[row][col])
            ? left_share * load_vector(cloth_entry(LEFT, index)) : vec3(0.0);
        product[row][col] -= in_free_directions(index, left);
    }
    FOR_BLOCK {
        int index = tile_index(first, row, col);
        vec3 residual = load_vector(cloth_entry(RESIDUAL, index)) - product[row][col];
        store_vector(cloth_entry(SOLUTION, index), value[row][col]);
        store_vector(cloth_entry(RESIDUAL, index), residual);
        store_vector(
            cloth_entry(SMOOTHED_INTO, index),
            first_step * times(load_cloth_inverse(index), residual));
    }
}
