// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Before the first iteration: the initial solution, its residual by the right side and by the
// residual of the previous pass, and the first smoothing.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform int start_field;  // field of the initial solution
uniform float guess;      // factor of start_field [1]
uniform float left_share; // factor of the residual of the previous pass: 1, or 0 without one

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
