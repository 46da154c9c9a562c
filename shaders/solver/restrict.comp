// Copyright 2026 the cloth_sim_ros authors
//
// Licensed under the Apache License, Version 2.0 (the "License");
// you may not use this file except in compliance with the License.
// You may obtain a copy of the License at
//
//     http://www.apache.org/licenses/LICENSE-2.0
//
// Unless required by applicable law or agreed to in writing, software
// distributed under the License is distributed on an "AS IS" BASIS,
// WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
// See the License for the specific language governing permissions and
// limitations under the License.

#version 430 core
// The residual of a coarse level from the defect of the level above, by the transpose of what
// solver/correction.glsl does, and its first smoothing.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

// Of the four finer nodes around a coarse one along a side of the level.
vec4 shares(int at, int count) {
    return vec4(
        at > 0 ? 0.25 : 0.0, at > 0 ? 0.75 : 1.0,
        at + 1 < count ? 0.75 : 1.0, at + 1 < count ? 0.25 : 0.0);
}

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (!inside(level, row, col)) {
        return;
    }
    vec4 down = shares(row, level_shape[level].x);
    vec4 across = shares(col, level_shape[level].y);
    vec3 residual = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 line = vec3(0.0);
        for (int j = 0; j < 4; ++j) {
            int index = level_index(level - 1, 2 * row - 1 + i, 2 * col - 1 + j);
            line += across[j] * load_vector(vector_entry(level - 1, DEFECT, index));
        }
        residual += down[i] * line;
    }
    int index = level_index(level, row, col);
    store_vector(vector_entry(level, RESIDUAL, index), residual);
    store_vector(
        vector_entry(level, SMOOTHED, index), FIRST_STEP * times_inverse(level, index, residual));
}
