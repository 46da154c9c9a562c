// SPDX-FileCopyrightText: 2026 the cloth_sim_ros authors
// SPDX-License-Identifier: Apache-2.0

// Sums over the invocations of a dispatch, in an order that never changes.
// SUMS_BY_GROUP: add up each workgroup here. A GPU has too many invocations to leave them all to
// reduce.comp; llvmpipe has few, and barriers cost it much.

#ifndef SUMS_ACCESS
#define SUMS_ACCESS writeonly
#endif
layout(std430, binding = SOLVER_SUMS) SUMS_ACCESS buffer PartialSums { vec4 partial_sums[]; };

#if SUMS_BY_GROUP
#define GROUP (LOCAL_X * LOCAL_Y)

shared vec3 group_sums[GROUP];

void store_sums(vec3 sums) {
    uint at = gl_LocalInvocationIndex;
    group_sums[at] = sums;
    for (uint half_way = GROUP / 2; half_way > 0u; half_way /= 2u) {
        barrier();
        if (at < half_way) {
            group_sums[at] += group_sums[at + half_way];
        }
    }
    if (at == 0u) {
        uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
        partial_sums[group] = vec4(group_sums[0], 0.0);
    }
}
#else
void store_sums(vec3 sums) {
    uint across = gl_NumWorkGroups.x * LOCAL_X;
    partial_sums[gl_GlobalInvocationID.y * across + gl_GlobalInvocationID.x] =
        vec4(sums, 0.0);
}
#endif
