// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Project the right side of listed nodes to their free directions, and add the impulse of the
// collider along its surface; reaction.comp needs the right side before. Other nodes are free.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "cells.glsl"
#include "solver/free_directions.glsl"
#include "solver/near_list.glsl"

layout(local_size_x = NEAR_LOCAL) in;

void main() {
    if (gl_GlobalInvocationID.x >= near_count) {
        return;
    }
    ivec2 at = near_node(gl_GlobalInvocationID.x);
    int index = node_index(at.y, at.x);
    vec3 right = load_vector(cloth_entry(RESIDUAL, index));
    vec3 given = mass_share(load_system(cloth_entry(NODE, index)))
        * load_vector(cloth_entry(GIVEN, index));
    store_vector(cloth_entry(RIGHT, index), right);
    store_vector(cloth_entry(RESIDUAL, index), in_free_directions(index, right + given));
}
