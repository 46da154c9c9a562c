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
// What smoothing leaves of the residual of a coarse level.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/level_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    ivec2 first = first_of_block();
    if (!in_level(first)) {
        return;
    }
    load_values(first, SMOOTHED_TWICE);
    make_product(first);
    FOR_BLOCK {
        if (tile_inside(first, row, col)) {
            int index = tile_index(first, row, col);
            vec3 residual = load_vector(vector_entry(level, RESIDUAL, index));
            store_vector(vector_entry(level, DEFECT, index), residual - product[row][col]);
        }
    }
}
