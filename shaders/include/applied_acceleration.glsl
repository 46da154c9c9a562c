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

// Acceleration that is not from springs: gravity and pushes.

uniform vec3 acceleration;  // [m/s2] gravity and pushes on the whole cloth

#if HAS_REGION_PUSHES
// Bit p of a node's mask: push p acts on it. Only the pushes of pushes_acting do so now.
layout(std430, binding = PUSH_MASK) readonly buffer PushMask { uint push_mask[]; };
uniform vec3 region_acceleration[MOST_REGION_PUSHES];  // [m/s2]
uniform uint pushes_acting;

vec3 applied_acceleration(int index) {
    vec3 total = acceleration;
    uint mask = push_mask[index] & pushes_acting;
    for (int p = 0; mask != 0u; ++p, mask >>= 1) {
        if ((mask & 1u) == 1u) {
            total += region_acceleration[p];
        }
    }
    return total;
}
#else
vec3 applied_acceleration(int index) { return acceleration; }
#endif
