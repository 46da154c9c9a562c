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
// The right side of the linearised step, over the node mass [m/s]: what applied accelerations and
// edges of frozen direction change in the velocity. Each edge pulls by
// edge_pulls times its extension and edge_weights times the rate of its length.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "state_in.glsl"
#include "solver/state_index.glsl"
#include "solver/cloth_tile.glsl"
#include "applied_acceleration.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float edge_pulls[3];   // [1/s] structural, shear, bend
uniform float rest_length[5];  // [m] along a row, along a column, diagonal, two along each
uniform float substep;         // [s]

vec3 velocity[TILE][TILE];
vec3 change[TILE][TILE];

void add_to_change(int row, int col, int drow, int dcol, int family, int rest) {
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    vec3 d = from.xyz - to.xyz;
    float square = max(dot(d, d), 1e-20);
    float inverse_length = inversesqrt(square);
    float extension = square * inverse_length - rest_length[rest];
    float rate = dot(d, velocity[row][col] - velocity[row + drow][col + dcol]) * inverse_length;
    float pull = edge_pulls[family] * extension + edge_weights[family] * rate;
    vec3 part = (abs(from.w * to.w) * pull * inverse_length) * d;
    change[row][col] -= part;
    change[row + drow][col + dcol] += part;
}

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    FOR_TILE {
        ivec2 at = first + ivec2(col, row) - REACH;
        node[row][col] = load_system(cloth_entry(NODE, tile_index(first, row, col)));
        velocity[row][col] = load_velocity(state_index(at.y, at.x)).xyz;
        change[row][col] = vec3(0.0);
    }
    FOR_CLOTH_EDGES(add_to_change)
    FOR_BLOCK {
        ivec2 at = first + ivec2(col, row) - REACH;
        vec3 total = vec3(0.0);
        if (is_free(node[row][col])) {
            vec3 applied = applied_acceleration(state_index(at.y, at.x));
            total = change[row][col] + substep * applied;
        }
        store_vector(cloth_entry(RESIDUAL, tile_index(first, row, col)), total);
    }
}
