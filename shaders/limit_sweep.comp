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
// Let no edge pass its limit at the end of the substep: Gauss-Seidel over the edges of CELLS x
// CELLS cells an invocation. Blocks of one colour share no node, so the order is fixed and
// velocities are changed in place. An edge's tension is what it took to hold its predicted
// length; it never pushes where it should pull, so an edge that comes back is let go.
// The impulse acts along the edge as it lies now, which keeps the angular momentum.

#include "lattice.glsl"
#include "edges.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = VELOCITY_OUT) buffer Velocity { vec4 velocity_out[]; };
layout(std430, binding = TENSION) buffer Tension { vec4 tension_out[]; };

uniform int colour;          // 0 to 3: parity of the block's column and row
uniform float substep;       // [s]
uniform float longest_next;  // [s] no later substep is longer
uniform float inverse_mass;  // [1/kg]

#define SIDE (CELLS + 1)
// Share of its rest length that a kept tension may move an edge in one substep.
#define MOST_KEPT 0.5

vec4 position[SIDE][SIDE];
vec4 velocity[SIDE][SIDE];

float limit_edge(float old, int row, int col, int row2, int col2, int rest) {
    vec4 from = position[row][col];
    vec4 to = position[row2][col2];
    vec4 v_from = velocity[row][col];
    vec4 v_to = velocity[row2][col2];
    float free = (v_from.w + v_to.w) * inverse_mass;
    if (from.w * to.w * free == 0.0) {
        return 0.0;
    }
    vec3 d = to.xyz - from.xyz;
    vec3 predicted = d + substep * (v_to.xyz - v_from.xyz);
    float ahead = length_and_inverse(predicted).x;
    float L0 = rest_length[rest];
    float per_length = 1.0 / (substep * substep * free);
    float pull = max(old + (ahead - L0 * (1.0 + limit)) * per_length, 0.0);
    float press = min(old + (ahead - L0 * (1.0 - limit)) * per_length, 0.0);
    float tension = (old >= 0.0 ? pull : 0.0) + (old <= 0.0 ? press : 0.0);
    if (tension == old) {
        return old;
    }
    vec3 change = ((tension - old) * substep * inverse_mass * length_and_inverse(d).y) * d;
    velocity[row][col].xyz += v_from.w * change;
    velocity[row2][col2].xyz -= v_to.w * change;
    float most = MOST_KEPT * L0 / (longest_next * longest_next * free);
    return clamp(tension, -most, most);
}

void main() {
    ivec2 block = 2 * ivec2(gl_GlobalInvocationID.xy) + ivec2(colour & 1, colour >> 1);
    ivec2 first = block * CELLS;
    if (first.x >= COLS || first.y >= ROWS) {
        return;
    }
    for (int row = 0; row < SIDE; ++row) {
        for (int col = 0; col < SIDE; ++col) {
            int index = node_index(first.y + row, first.x + col);
            position[row][col] = load_position(index);
            velocity[row][col] = velocity_out[index];
        }
    }
    for (int row = 0; row < CELLS; ++row) {
        for (int col = 0; col < CELLS; ++col) {
            int index = node_index(first.y + row, first.x + col);
            vec4 t = tension_out[index];
#if HAS_STRUCTURAL
            t[EDGE_ROW] = limit_edge(t[EDGE_ROW], row, col, row, col + 1, REST_ROW);
            t[EDGE_COLUMN] = limit_edge(t[EDGE_COLUMN], row, col, row + 1, col, REST_COLUMN);
#endif
#if HAS_SHEAR
            t[EDGE_DIAGONAL] =
                limit_edge(t[EDGE_DIAGONAL], row, col, row + 1, col + 1, REST_DIAGONAL);
            t[EDGE_CROSSING] =
                limit_edge(t[EDGE_CROSSING], row, col + 1, row + 1, col, REST_DIAGONAL);
#endif
            tension_out[index] = t;
        }
    }
    for (int row = 0; row < SIDE; ++row) {
        for (int col = 0; col < SIDE; ++col) {
            int index = node_index(first.y + row, first.x + col);
            if (first.y + row < ROWS && first.x + col < COLS) {
                velocity_out[index] = velocity[row][col];
            }
        }
    }
}
