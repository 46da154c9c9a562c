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
// A scalar product by the paper's reduction in shared memory, its Fig. 6: a sum for a workgroup.

#include "paper_solver/buffers.glsl"

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
