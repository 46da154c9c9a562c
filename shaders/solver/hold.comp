// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Project the right side of nodes in contact to their free directions, and add the impulse of the
// collider along its surface; reaction.comp needs the right side before.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "cells.glsl"
#include "solver/free_directions.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec3 right = load_vector(cloth_entry(RESIDUAL, index));
    vec3 given = mass_share(load_system(cloth_entry(NODE, index)))
        * load_vector(cloth_entry(GIVEN, index));
    store_vector(cloth_entry(RIGHT, index), right);
    store_vector(cloth_entry(RESIDUAL, index), in_free_directions(index, right + given));
}
