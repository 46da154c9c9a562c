// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// The system matrix times the direction.

#include "paper/solver/buffers.glsl"

layout(local_size_x = 1024) in;

void main() {
    int i = int(gl_GlobalInvocationID.x);
    if (i >= CONSTRAINTS) {
        return;
    }
    float sum = 0.0;
    int count = int(row_count[i]);
    for (int k = ROW_SLOTS * i; k < ROW_SLOTS * i + count; ++k) {
        sum += coo[k].z * ENTRY(DIRECTION, int(coo[k].y));
    }
    ENTRY(IMAGE, i) = sum;
}
