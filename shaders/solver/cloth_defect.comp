// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// What smoothing leaves of the residual of the cloth.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    load_edges(first);
    load_values(first, SMOOTHED_TWICE);
    make_product(first);
    FOR_BLOCK {
        int index = tile_index(first, row, col);
        vec3 residual = load_vector(cloth_entry(RESIDUAL, index));
        store_vector(cloth_entry(DEFECT, index), residual - product[row][col]);
    }
}
