// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// Invert the diagonal blocks of a coarse level.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/invert_level.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (inside(level, row, col)) {
        invert_node(row, col);
    }
}
