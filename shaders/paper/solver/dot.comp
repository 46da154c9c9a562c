// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

#version 430 core
// A scalar product by the paper's reduction in shared memory, its Fig. 6: a sum for a workgroup.

#include "paper/solver/buffers.glsl"

layout(local_size_x = 1024) in;

uniform int first_field;
uniform int second_field;

shared float sums[1024];

void main() {
    int i = int(gl_GlobalInvocationID.x);
    uint at = gl_LocalInvocationIndex;
    sums[at] = i < CONSTRAINTS ? ENTRY(first_field, i) * ENTRY(second_field, i) : 0.0;
    for (uint half_way = 512u; half_way > 0u; half_way /= 2u) {
        barrier();
        if (at < half_way) {
            sums[at] += sums[at + half_way];
        }
    }
    if (at == 0u) {
        scalars[GROUP_SUMS + int(gl_WorkGroupID.x)] = sums[0];
    }
}
