// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add the correction of the level below to the smoothed residual, and smooth again.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/level_product.glsl"
#include "solver/correction.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    ivec2 first = first_of_block();
    if (!in_level(first)) {
        return;
    }
    load_values(first, SMOOTHED_TWICE);
    load_correction(level + 1, first);
    FOR_TILE {
        value[row][col] += correction[row][col];
    }
    make_product(first);
    FOR_BLOCK {
        if (tile_inside(first, row, col)) {
            int index = tile_index(first, row, col);
            vec3 left = load_vector(vector_entry(level, RESIDUAL, index)) - product[row][col];
            store_vector(
                vector_entry(level, CORRECTED, index),
                value[row][col] + second_step * times_inverse(level, index, left));
        }
    }
}
