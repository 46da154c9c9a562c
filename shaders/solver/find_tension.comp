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
// The tension of each edge: what the right side began it with, and what the solution adds.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_tile.glsl"

#define TENSION_ACCESS
#include "solver/tension.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float substep;  // [s]

vec3 solution[TILE][TILE];

void find(ivec2 first, int row, int col, int drow, int dcol, int family) {
    if (!is_in_block(row, col)) {
        return;
    }
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    vec3 d = from.xyz - to.xyz;
    float rate = dot(d, solution[row][col] - solution[row + drow][col + dcol])
        * inversesqrt(max(dot(d, d), 1e-20));
    int index = tile_index(first, row, col);
    tension[tension_entry(TENSION_FOUND, index, drow, dcol)] =
        tension[tension_entry(TENSION_BEGUN, index, drow, dcol)]
        + edge_weight(from, to, family) * rate / substep;
}

#define FIND(row, col, drow, dcol, family, rest) find(first, row, col, drow, dcol, family)

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    FOR_TILE {
        int index = tile_index(first, row, col);
        node[row][col] = load_system(cloth_entry(NODE, index));
        solution[row][col] = load_vector(cloth_entry(SOLUTION, index));
    }
    FOR_CLOTH_EDGES(FIND)
}
