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

uniform vec3 acceleration;         // [m/s2] gravity and pushes on the whole cloth
uniform bool has_region_pushes;    // some nodes are pushed and others are not

// What pushes on regions add at a node [m/s2]; w: how many act on it. Bound only while some do.
layout(std430, binding = REGION_PUSHES) readonly buffer RegionPushes { vec4 region_pushes[]; };

vec3 applied_acceleration(int index) {
    vec3 applied = acceleration;
    if (has_region_pushes) {
        applied += region_pushes[index].xyz;
    }
    return applied;
}

bool is_pushed_in_region(int index) {
    return has_region_pushes && region_pushes[index].w > 0.0;
}
