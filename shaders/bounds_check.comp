// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

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
