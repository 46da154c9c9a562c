// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The residual of a coarse level from the defect of the level above, and its first smoothing.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/smoothing_steps.glsl"
#include "solver/restriction.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#define COARSE_BLOCK 2  // nodes along each side of an invocation
#define FINER_TILE (2 * COARSE_BLOCK + 2)

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.yx) * COARSE_BLOCK;
    if (!inside(level, first.x, first.y)) {
        return;
    }
    vec3 lines[FINER_TILE][COARSE_BLOCK];
    for (int row = 0; row < FINER_TILE; ++row) {
        vec3 line[FINER_TILE];
        for (int col = 0; col < FINER_TILE; ++col) {
            // Nodes beyond the finer level have no weight.
            ivec2 at = min(2 * first - 1 + ivec2(row, col), level_shape[level - 1].xy);
            line[col] = load_vector(
                vector_entry(level - 1, DEFECT, level_index(level - 1, at.x, at.y)));
        }
        for (int col = 0; col < COARSE_BLOCK; ++col) {
            vec4 across = shares(first.y + col, level_shape[level].y);
            lines[row][col] = across[0] * line[2 * col] + across[1] * line[2 * col + 1]
                + across[2] * line[2 * col + 2] + across[3] * line[2 * col + 3];
        }
    }
    for (int row = 0; row < COARSE_BLOCK; ++row) {
        vec4 down = shares(first.x + row, level_shape[level].x);
        for (int col = 0; col < COARSE_BLOCK; ++col) {
            ivec2 at = first + ivec2(row, col);
            vec3 residual = down[0] * lines[2 * row][col] + down[1] * lines[2 * row + 1][col]
                + down[2] * lines[2 * row + 2][col] + down[3] * lines[2 * row + 3][col];
            if (inside(level, at.x, at.y)) {
                int index = level_index(level, at.x, at.y);
                store_vector(vector_entry(level, RESIDUAL, index), residual);
                store_vector(
                    vector_entry(level, SMOOTHED, index),
                    first_step * times_inverse(level, index, residual));
            }
        }
    }
}
