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
// Invert the diagonal block of each node of the cloth.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/edge_weight.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

Symmetric edge_block(vec4 here, int index, int family) {
    vec4 there = load_system(cloth_entry(NODE, index));
    vec3 d = here.xyz - there.xyz;
    return weight_over_square(here, there, d, family) * outer_square(d);
}

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    int index = node_index(row, col);
    vec4 here = load_system(cloth_entry(NODE, index));
    Symmetric diagonal = scaled_identity(1.0);
#define ADD_BOTH_WAYS(DROW, DCOL, FAMILY) \
    diagonal += edge_block(here, index + (DROW) * PITCH + (DCOL), FAMILY) \
        + edge_block(here, index - (DROW) * PITCH - (DCOL), FAMILY);
#if HAS_STRUCTURAL
    ADD_BOTH_WAYS(0, 1, STRUCTURAL)
    ADD_BOTH_WAYS(1, 0, STRUCTURAL)
#endif
#if HAS_SHEAR
    ADD_BOTH_WAYS(1, 1, SHEAR)
    ADD_BOTH_WAYS(1, -1, SHEAR)
#endif
#if HAS_BEND
    ADD_BOTH_WAYS(0, 2, BEND)
    ADD_BOTH_WAYS(2, 0, BEND)
#endif
    float moves = is_free(here) ? 1.0 : 0.0;
    Symmetric inverse_block = moves * inverse_above(diagonal, 1.0);
    system_data[cloth_entry(INVERSE, index)] = vec4(inverse_block[0], 0.0);
    system_data[cloth_entry(INVERSE + 1, index)] = vec4(inverse_block[1], 0.0);
}
