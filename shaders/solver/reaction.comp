// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Impulses of the colliders in a solve: the matrix times the solution less the right side, in all
// directions.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float left_share;  // of LEFT, that the solve has begun with

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    bool touches = false;
    FOR_BLOCK {
        touches = touches || load_contact(tile_index(first, row, col)).w > 0.0;
    }
    if (!touches) {
        return;
    }
    load_edges(first);
    load_values(first, SOLUTION);
    make_whole_product(first);
    FOR_BLOCK {
        int index = tile_index(first, row, col);
        if (load_contact(index).w > 0.0) {
            vec3 reaction = load_vector(cloth_entry(REACTION, index));
            vec3 right = load_vector(cloth_entry(RIGHT, index))
                + left_share * load_vector(cloth_entry(LEFT, index))
                - load_vector(cloth_entry(RESIDUAL, index));
            // As a change of the velocity.
            float inverse_share = 1.0 / mass_share(node[row][col]);
            store_vector(
                cloth_entry(REACTION, index),
                reaction + inverse_share * (product[row][col] - right));
        }
    }
}
