// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Nearly solve the coarsest level in one workgroup, where other levels have passes of their own.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/edge_tensors.glsl"

layout(local_size_x = COARSEST_SIDE, local_size_y = COARSEST_SIDE) in;

#define COARSEST_GROUP (COARSEST_SIDE * COARSEST_SIDE)
#include "solver/coarsest_level.glsl"

void main() {
    ivec2 at = ivec2(gl_LocalInvocationID.yx);
    bool is_node = inside(level, at.x, at.y);
    int index = is_node ? level_index(level, at.x, at.y) : 0;
    vec3 value =
        nearly_solve(at, is_node, load_vector(vector_entry(level, RESIDUAL, index)));
    if (is_node) {
        store_vector(vector_entry(level, PRECONDITIONED, index), value);
    }
}
