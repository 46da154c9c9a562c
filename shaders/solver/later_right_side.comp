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
// The right side of a further solve of the same step, with edges as the solves before have left
// them: what is left of each edge's law there pulls. Forces and velocities had their part before.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "solver/cloth_tile.glsl"

#define TENSION_ACCESS
#include "solver/tension.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float edge_keeps[3];   // share of its tension that an edge keeps: structural, shear, bend
uniform float rest_length[5];  // [m] along a row, along a column, diagonal, two along each
uniform float substep;         // [s]
uniform float offset_share;    // of the offsets of rest lengths, at the end of the step

vec3 change[TILE][TILE];

void add_to_change(ivec2 first, int row, int col, int drow, int dcol, int family, int rest) {
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    vec3 d = from.xyz - to.xyz;
    float square = max(dot(d, d), 1e-20);
    float inverse_length = inversesqrt(square);
    float share = edge_share(from, to, family);
    int index = tile_index(first, row, col);
    float offset = offset_share * tension[tension_entry(TENSION_OFFSET, index, drow, dcol)];
    float added = share * edge_weights[family] / (substep * substep)
        * (square * inverse_length - rest_length[rest] - offset);
#if HAS_LAG
    added -= tension[tension_entry(TENSION_LAG, index, drow, dcol)];
#endif
    float found = tension[tension_entry(TENSION_FOUND, index, drow, dcol)];
    added -= (1.0 - edge_keeps[family]) * found;
    if (is_in_block(row, col)) {
        tension[tension_entry(TENSION_BEGUN, index, drow, dcol)] = found + added;
    }
    vec3 part = (substep * added * inverse_length) * d;
    change[row][col] -= part;
    change[row + drow][col + dcol] += part;
}

#define ADD(row, col, drow, dcol, family, rest) \
    add_to_change(first, row, col, drow, dcol, family, rest)

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    FOR_TILE {
        node[row][col] = load_system(cloth_entry(NODE, tile_index(first, row, col)));
        change[row][col] = vec3(0.0);
    }
    FOR_CLOTH_EDGES(ADD)
    FOR_BLOCK {
        vec3 total = is_free(node[row][col]) ? change[row][col] : vec3(0.0);
        store_vector(cloth_entry(RESIDUAL, tile_index(first, row, col)), total);
    }
}
