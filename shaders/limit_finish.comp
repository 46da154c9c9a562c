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
// tensions pull, for the length of the next substep.

#include "lattice.glsl"
#include "edges.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = POSITION_OUT) writeonly buffer PositionOut { vec4 position_out[]; };
layout(std430, binding = VELOCITY_OUT) readonly buffer Velocity { vec4 velocity_out[]; };
layout(std430, binding = TENSION) readonly buffer Tension { vec4 tension[]; };
layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };

uniform float substep;  // [s]

// Sum of abs(tension) / L0 over the edges of a free node [N/m].
float pull_on(int row, int col) {
    int index = node_index(row, col);
    vec4 here = abs(tension[index]);
    vec4 left = abs(tension[index - 1]);
    vec4 above = abs(tension[index - PITCH]);
    vec4 corner = abs(tension[index - PITCH - 1]);
    return (here[EDGE_ROW] + left[EDGE_ROW]) / rest_length[REST_ROW]
        + (here[EDGE_COLUMN] + above[EDGE_COLUMN]) / rest_length[REST_COLUMN]
        + (here[EDGE_DIAGONAL] + left[EDGE_CROSSING] + above[EDGE_CROSSING]
           + corner[EDGE_DIAGONAL]) / rest_length[REST_DIAGONAL];
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    float pull = 0.0;
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        int index = node_index(row, col);
        vec4 x = load_position(index);
        vec4 v = velocity_out[index];
        position_out[index] = vec4(x.xyz + substep * v.xyz, x.w);
        pull = max(pull, v.w * pull_on(row, col));
    }
    partial_sums[strip * COLS + col] = pull;
}
