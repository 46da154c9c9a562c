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
// edges of frozen direction change in the velocity. Each edge pulls by edge_pulls times its
// extension and edge_weights times the rate of its length.
// FORESEES_TURN: an edge also pulls back what moving across its direction will lengthen it by.
// KEEPS_TENSION: begin each edge's tension with its pull, and allow for offsets of rest lengths.

#include "solver/levels.glsl"
#include "solver/vectors.glsl"
#include "solver/system.glsl"
#include "state_in.glsl"
#include "solver/state_index.glsl"
#include "solver/cloth_tile.glsl"
#include "applied_acceleration.glsl"

#if KEEPS_TENSION
#define TENSION_ACCESS
#include "solver/tension.glsl"
#endif

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

uniform float edge_pulls[3];   // [1/s] structural, shear, bend
uniform float rest_length[5];  // [m] along a row, along a column, diagonal, two along each
uniform float substep;         // [s]
#if KEEPS_TENSION
uniform float offset_share;   // of the offsets of rest lengths, at the end of the step
#endif
#if KEEPS_TENSION && HAS_LAG
uniform float edge_lags[3];    // [1/s2] damping over the length of the step
#endif

vec3 velocity[TILE][TILE];
#if FORESEES_TURN
vec3 foreseen[TILE][TILE];     // velocity with the applied acceleration alone
#endif
vec3 change[TILE][TILE];

// The rate at which an edge of length l along n grows by moving at u, besides dot(u, n).
float growth_by_turning(float l, vec3 n, vec3 u) {
    vec3 across = substep * (u - dot(u, n) * n);
    float square = dot(across, across);
    return square / ((sqrt(l * l + square) + l) * substep);
}

void add_to_change(ivec2 first, int row, int col, int drow, int dcol, int family, int rest) {
    vec4 from = node[row][col];
    vec4 to = node[row + drow][col + dcol];
    vec3 d = from.xyz - to.xyz;
    float square = max(dot(d, d), 1e-20);
    float inverse_length = inversesqrt(square);
    float l = square * inverse_length;
    vec3 n = inverse_length * d;
    float rate = dot(n, velocity[row][col] - velocity[row + drow][col + dcol]);
#if FORESEES_TURN
    rate += growth_by_turning(l, n, foreseen[row][col] - foreseen[row + drow][col + dcol]);
#endif
    float share = edge_share(from, to, family);
    float extension = l - rest_length[rest];
#if KEEPS_TENSION
    int index = tile_index(first, row, col);
    extension -= offset_share * tension[tension_entry(TENSION_OFFSET, index, drow, dcol)];
#endif
    float pull = share * (edge_pulls[family] * extension + edge_weights[family] * rate);
#if KEEPS_TENSION
    if (is_in_block(row, col)) {
        tension[tension_entry(TENSION_BEGUN, index, drow, dcol)] = pull / substep;
#if HAS_LAG
        tension[tension_entry(TENSION_LAG, index, drow, dcol)] =
            share * edge_lags[family] * extension;
#endif
    }
#endif
    change[row][col] -= pull * n;
    change[row + drow][col + dcol] += pull * n;
}

#define ADD(row, col, drow, dcol, family, rest) \
    add_to_change(first, row, col, drow, dcol, family, rest)

void main() {
    ivec2 first = first_of_block();
    if (!in_cloth(first)) {
        return;
    }
    FOR_TILE {
        ivec2 at = first + ivec2(col, row) - REACH;
        int index = state_index(at.y, at.x);
        node[row][col] = load_system(cloth_entry(NODE, tile_index(first, row, col)));
        velocity[row][col] = load_velocity(index).xyz;
#if FORESEES_TURN
        foreseen[row][col] = velocity[row][col];
        if (is_free(node[row][col])) {
            foreseen[row][col] += substep * applied_acceleration(index);
        }
#endif
        change[row][col] = vec3(0.0);
    }
    FOR_CLOTH_EDGES(ADD)
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
