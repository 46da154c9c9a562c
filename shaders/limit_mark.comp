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
// Mark which edges are at their limit, four bits a cell, and keep the marks of the time before in
// the next four bits. MARKS_TENSION: an edge is at its limit while it is held there; otherwise,
// while it is beyond it.

#include "lattice.glsl"
#include "edges.glsl"
#include "state_in.glsl"
#include "spring_law.glsl"
#include "strain_limit.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

#if MARKS_TENSION
layout(std430, binding = TENSION) readonly buffer Tension { vec4 tension[]; };
#endif
layout(std430, binding = AT_LIMIT) buffer AtLimit { uint at_limit[]; };

bool is_at_limit(int row, int col, int row2, int col2, int edge, int rest) {
#if MARKS_TENSION
    return tension[node_index(row, col)][edge] != 0.0;
#else
    vec4 from = load_position(node_index(row, edge == EDGE_CROSSING ? col2 : col));
    vec4 to = load_position(node_index(row2, edge == EDGE_CROSSING ? col : col2));
    float now = length_and_inverse(to.xyz - from.xyz).x;
    return from.w * to.w != 0.0 && is_beyond_limit(now, rest_length[rest]);
#endif
}

uint mark(int row, int col, int drow, int dcol, int edge, int rest) {
    return is_at_limit(row, col, row + drow, col + dcol, edge, rest) ? 1u << edge : 0u;
}

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int row = int(gl_GlobalInvocationID.y);
    if (row >= ROWS || col >= COLS) {
        return;
    }
    uint marks = 0u;
#if HAS_STRUCTURAL
    marks |= mark(row, col, 0, 1, EDGE_ROW, REST_ROW);
    marks |= mark(row, col, 1, 0, EDGE_COLUMN, REST_COLUMN);
#endif
#if HAS_SHEAR
    marks |= mark(row, col, 1, 1, EDGE_DIAGONAL, REST_DIAGONAL);
    marks |= mark(row, col, 1, 1, EDGE_CROSSING, REST_DIAGONAL);
#endif
    int index = node_index(row, col);
    at_limit[index] = (at_limit[index] & 15u) << 4 | marks;
}
