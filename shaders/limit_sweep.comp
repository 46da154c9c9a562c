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
// SWEEP_LAW:
// LIMIT_LAW: the above.
// PAPER_LAW: edges that are beyond the limit now are brought to their rest length, to first order.

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
uniform float correction;    // share of what is beyond the limit that a substep takes back
uniform float longest_next;  // [s] no later substep is longer
uniform float inverse_mass;  // [1/kg]

#define LIMIT_LAW 0
#define PAPER_LAW 1
// Of a multiplier, in units of what moves its edge: there are more constraints than nodes to move,
// so without it they have no unique multipliers.
#define COMPLIANCE 1e-3
#define SIDE (CELLS + 1)
// Share of its rest length that a kept tension may move an edge in one substep.
#define MOST_KEPT 0.5

vec4 position[SIDE][SIDE];
vec4 velocity[SIDE][SIDE];

// Without branches: lanes of different edges run together.
float limit_edge(float old, int row, int col, int row2, int col2, int rest) {
    vec4 from = position[row][col];
    vec4 to = position[row2][col2];
    vec4 v_from = velocity[row][col];
    vec4 v_to = velocity[row2][col2];
    vec3 d = to.xyz - from.xyz;
    vec3 dv = v_to.xyz - v_from.xyz;
    vec2 now = length_and_inverse(d);
    float L0 = rest_length[rest];
    float free = v_from.w + v_to.w;
    // 0 where an end is a ghost or none can move.
    float present = from.w * to.w * min(free, 1.0);
    float per_length = present / (substep * substep * inverse_mass * max(free, 1.0));
#if SWEEP_LAW == PAPER_LAW
    // Phi = d.d - L0^2 and its change, over 2 l.
    float ahead = (0.5 * (now.x * now.x - L0 * L0) + substep * dot(d, dv)) * now.y;
    float tension = is_beyond_limit(now.x, L0)
        ? (old + ahead * per_length) / (1.0 + COMPLIANCE) : 0.0;
    float kept = tension;
#else
    float ahead = length_and_inverse(d + substep * dv).x;
    // What is beyond the limit already comes back bit by bit.
    float beyond = (1.0 - correction) * beyond_limit(now.x, L0);
    float pull = max(old + (ahead - L0 * (1.0 + limit) - max(beyond, 0.0)) * per_length, 0.0);
    float press = min(old + (ahead - L0 * (1.0 - limit) - min(beyond, 0.0)) * per_length, 0.0);
    float tension = present * ((old >= 0.0 ? pull : 0.0) + (old <= 0.0 ? press : 0.0));
    float most = MOST_KEPT * L0 / (longest_next * longest_next * inverse_mass * max(free, 1.0));
    float kept = clamp(tension, -most, most);
#endif
    vec3 change = (present * (tension - old) * substep * inverse_mass * now.y) * d;
    velocity[row][col].xyz += v_from.w * change;
    velocity[row2][col2].xyz -= v_to.w * change;
    return kept;
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
