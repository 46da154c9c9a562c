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

// Sums over the invocations of a dispatch, in an order that never changes.
// SUMS_BY_GROUP: add up each workgroup here. A GPU has too many invocations to leave them all to
// reduce.comp; llvmpipe has few, and barriers cost it much.

layout(std430, binding = SOLVER_SUMS) writeonly buffer PartialSums { vec4 partial_sums[]; };

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
