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
// End a substep whose velocities the sweeps have settled: move the nodes, and say how hard the
// tensions pull, for the length of the next substep, and what energy they took, for how much of an
// overshoot may be taken back.

#include "lattice.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"
#include "tension_in.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = POSITION_OUT) writeonly buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) readonly buffer Velocity { vec4 velocity_out[]; };
layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { vec4 partial_sums[]; };

uniform float substep;     // [s]
uniform float kick;        // [s] what tensions acted for
uniform float held_share;  // length of an edge held at the limit over that at the scene's limit

// What tensions pull with over the length of their edges, as they are at the scene's limit [N/m].
vec4 pulls(vec4 held) { return max(held, vec4(0.0)) / held_share + max(-held, vec4(0.0)); }

// Sum of pulls over L0 at the edges of a node [N/m].
float pull_on(int index) {
    vec4 here = pulls(load_tensions(index));
    vec4 left = pulls(load_tensions(index - 1));
    vec4 above = pulls(load_tensions(index - PITCH));
    vec4 corner = pulls(load_tensions(index - PITCH - 1));
    return (here[EDGE_ROW] + left[EDGE_ROW]) / rest_length[REST_ROW]
        + (here[EDGE_COLUMN] + above[EDGE_COLUMN]) / rest_length[REST_COLUMN]
        + (here[EDGE_DIAGONAL] + left[EDGE_CROSSING] + above[EDGE_CROSSING]
           + corner[EDGE_DIAGONAL]) / rest_length[REST_DIAGONAL];
}

// Of one edge: the kinetic energy that its tension took in this substep, and the work against it
// that would bring the edge back to its limit [J].
vec2 energies(float held, int from, int to, int rest) {
    vec3 d = load_position(to).xyz - load_position(from).xyz;
    vec3 before = load_velocity(to).xyz - load_velocity(from).xyz;
    vec3 now = velocity_out[to].xyz - velocity_out[from].xyz;
    float taken = 0.5 * kick * held * dot(before + now, d) * length_and_inverse(d).y;
    float length_now = length_and_inverse(d + substep * now).x;
    return vec2(taken, max(held * beyond_limit(length_now, rest_length[rest]), 0.0));
}

vec2 energies_of_cell(int index) {
    vec4 held = load_tensions(index);
    if (held == vec4(0.0)) {
        return vec2(0.0);
    }
    return energies(held[EDGE_ROW], index, index + 1, REST_ROW)
        + energies(held[EDGE_COLUMN], index, index + PITCH, REST_COLUMN)
        + energies(held[EDGE_DIAGONAL], index, index + PITCH + 1, REST_DIAGONAL)
        + energies(held[EDGE_CROSSING], index + 1, index + PITCH, REST_DIAGONAL);
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    float pull = 0.0;
    vec2 energy = vec2(0.0);
    float square = 0.0;
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        int index = node_index(row, col);
        vec4 x = load_position(index);
        vec4 v = velocity_out[index];
        position_out[index] = vec4(x.xyz + substep * v.xyz, x.w);
        pull = max(pull, v.w * pull_on(index));
        energy += energies_of_cell(index);
        square += v.w * dot(v.xyz, v.xyz);
    }
    partial_sums[strip * COLS + col] = vec4(pull, energy, square);
}
