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
// Invert the diagonal blocks of a coarse level.

#include "solver/levels.glsl"
#include "solver/system.glsl"
#include "solver/edge_tensors.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

void main() {
    int row = int(gl_GlobalInvocationID.y);
    int col = int(gl_GlobalInvocationID.x);
    if (!inside(level, row, col)) {
        return;
    }
    int index = level_index(level, row, col);
    Symmetric diagonal = load_symmetric(level, GROUND, index);
    for (int i = 0; i < DIRECTIONS; ++i) {
        int behind = level_index(level, row - TOWARDS[i].x, col - TOWARDS[i].y);
        diagonal += load_edge(level, index, i) + load_edge(level, behind, i);
    }
    // No coarse node holds less than the mass of one node.
    store_symmetric(level, INVERSE, index, inverse_above(diagonal, 1.0));
}
