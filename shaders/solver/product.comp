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
// The matrix times the preconditioned residual, and what two scalar products get from each block.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_product.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#include "solver/partial_sums.glsl"

void main() {
    ivec2 first = first_of_block();
    vec3 sums = vec3(0.0);
    if (in_cloth(first)) {
        load_edges(first);
        load_values(first, PRECONDITIONED);
        make_product();
        FOR_BLOCK {
            int index = tile_index(first, row, col);
            vec3 residual = load_vector(cloth_entry(RESIDUAL, index));
            store_vector(cloth_entry(PRODUCT, index), product[row][col]);
            vec3 solution = load_vector(cloth_entry(SOLUTION, index));
            sums += vec3(
                dot(residual, value[row][col]), dot(product[row][col], value[row][col]),
                dot(solution, solution));
        }
    }
    store_sums(sums);
}
