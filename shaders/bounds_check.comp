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
// Whether a position or velocity is out of bounds, for each invocation, which looks at STRIP
// nodes of a column: 1, or 0 where all are good.

#include "lattice.glsl"
#include "state_in.glsl"
#include "bounded.glsl"

layout(local_size_x = LOCAL_X, local_size_y = LOCAL_Y) in;

layout(std430, binding = PARTIAL_SUMS) writeonly buffer PartialSums { float partial_sums[]; };

void main() {
    int col = int(gl_GlobalInvocationID.x);
    int strip = int(gl_GlobalInvocationID.y);
    int first = strip * STRIP;
    if (first >= ROWS || col >= COLS) {
        return;
    }
    bool is_good = true;
    for (int row = first; row < min(first + STRIP, ROWS); ++row) {
        int index = node_index(row, col);
        is_good = is_good && is_bounded(load_position(index).xyz)
            && is_bounded(load_velocity(index).xyz);
    }
    partial_sums[strip * COLS + col] = is_good ? 0.0 : 1.0;
}
