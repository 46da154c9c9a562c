// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Add the correction of level 1 to what smoothing made of the residual of the cloth, and smooth
// again.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/cloth_product.glsl"
#include "solver/correction.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    load_edges(first);
    load_values(first, SMOOTHED_TWICE);
    load_correction(1, first);
    FOR_TILE {
        if (is_free(node[row][col])) {
            value[row][col] += correction[row][col];
        }
    }
#if HAS_CONTACT
    bool touches = false;
    FOR_TILE {
        touches = touches || load_contact(tile_index(first, row, col)).w > 0.0;
    }
    if (touches) {
        FOR_TILE {
            value[row][col] =
                in_free_directions(tile_index(first, row, col), value[row][col]);
        }
    }
#endif
#if HAS_SURFACE
    FOR_BLOCK {
        store_vector(
            cloth_entry(SURFACE_VALUE, tile_index(first, row, col)), value[row][col]);
    }
#endif
    make_product(first);
    FOR_BLOCK {
        int index = tile_index(first, row, col);
        vec3 left = load_vector(cloth_entry(RESIDUAL, index)) - product[row][col];
        store_vector(
            cloth_entry(CORRECTED, index),
            value[row][col] + second_step * times(load_cloth_inverse(index), left));
    }
}
