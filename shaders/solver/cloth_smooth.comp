// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// One more step of smoothing the cloth: from SMOOTHED to SMOOTHED_TWICE on the way down, from
// CORRECTED to PRECONDITIONED on the way up, which are the same fields; or the residual after both
// steps. One program does both, as most of it is the product.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform bool goes_up;
uniform bool finds_defect;

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    load_edges(first);
    load_values(first, finds_defect ? SMOOTHED_TWICE : SMOOTHED);
    make_product(first);
    float step_size = goes_up ? first_step : second_step;
    FOR_BLOCK {
        int index = tile_index(first, row, col);
        vec3 left = load_vector(cloth_entry(RESIDUAL, index)) - product[row][col];
        vec3 smoothed = value[row][col] + step_size * times(load_cloth_inverse(index), left);
        store_vector(
            cloth_entry(finds_defect ? DEFECT : PRECONDITIONED, index),
            finds_defect ? left : smoothed);
    }
}
